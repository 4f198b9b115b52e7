// What cannot be done from here now, and why: one line for each, which stands in the tooltip of what is grey, and is
// said where a key asks for it. In: what the server offers and how the viewer shows it. Out: the line; empty: it can be
// done.
#pragma once

#include <cstddef>
#include <string>

namespace framelet {

/// Text that is shown where another viewer has the scene's clock at its disposal.
inline constexpr char const* watching_text = "another viewer controls the scene's clock";
/// Text that is shown where no scene's clock moves anything.
inline constexpr char const* nothing_moves_text = "nothing moves in this scene";

/// Says why the scene's clock cannot be set. `is_gone`: there is no session. `moves`: the scene has animation.
/// `controls`: as in Status.
std::string clock_lacks(bool is_gone, bool moves, bool controls);
/// Says why none of the scene's cameras can be looked through. `count`: how many it has.
std::string scene_cameras_lack(std::size_t count);
/// Says why the bookmark of this number, from 0, cannot be gone to. `count`: how many there are.
std::string bookmark_lacks(std::size_t count, int number);
/// Says why the bookmark of this number cannot be removed. -1: none has been gone to.
std::string removal_lacks(std::size_t count, int number);
/// Says why the scene cannot be shown late. `moves_samples`: as `ViewerSettings::reproject`.
std::string smoothing_lacks(bool moves, bool moves_samples);
/// Says why the confidence of pixels cannot be drawn over the picture.
std::string confidence_lacks(bool moves_samples);
/// Says why this text of the clipboard is no view to be gone to; what is wrong in a camera file is for its reader.
std::string clipboard_lacks(std::string const& text);
/// Says why no screenshot or film can be taken.
std::string picture_lacks(bool has_picture);

} // namespace framelet
