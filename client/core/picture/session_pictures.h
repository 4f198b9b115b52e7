// The picture of this session and, until that is a whole one, of the session before. In: batches of this session, and
// what is wanted. Out: pictures of one of both. They are not mixed: the server knows nothing of what is held of the
// session before, and would not correct it where it has become wrong.
#pragma once

#include <memory>
#include <vector>

#include "client/core/picture/picture_maker.h"

namespace framelet {

class SessionPictures {
public:
    /// The maker that takes batches of this view; it holds nothing yet where `held_since` is another than last time.
    PictureMaker& prepare(NumberedView const& wanted, PictureSettings const& settings);
    /// True where there is a maker of this session, and it is for this view.
    bool is_for(NumberedView const& view) const { return current_ && since_ == view.held_since; }

    /// This session was interrupted: its picture goes on being shown at this scene time, until `resume` or
    /// `begin_anew`.
    void pause(SceneTime present);
    /// The session that was interrupted goes on.
    void resume() { is_paused_ = false; }
    /// Another session begins, which has sent nothing yet.
    void begin_anew();
    /// Drops what is held of the session before, as where that was of another scene.
    void forget_earlier();

    /// Shows a picture as `PictureMaker::show` does: that of the session before until this one's covers as much or is
    /// complete, which is found out by making both, or has another size and shows anything. Call it after `prepare`.
    bool show(PictureRequest const& request, Picture& picture, std::vector<PixelRect>& changed,
              BlockCanvas* canvas = nullptr);
    /// The maker whose picture is shown; null before the first `prepare`.
    PictureMaker* shown() const { return (earlier_ ? earlier_ : current_).get(); }
    std::size_t memory_bytes() const;

private:
    void keep_as_earlier();
    bool replaces_earlier(PictureRequest const& request);

    std::unique_ptr<PictureMaker> current_;
    std::uint64_t since_ = 0; ///< `held_since` of the views that `current_` is for
    std::unique_ptr<PictureMaker> earlier_;
    bool is_paused_ = false;
    SceneTime paused_ = 0; ///< that `earlier_` shows
    Picture unseen_; ///< this session's, while that of the one before is shown
    std::vector<PixelRect> unseen_changes_; ///< scratch
};

} // namespace framelet
