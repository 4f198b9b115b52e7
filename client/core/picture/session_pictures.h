// The picture of this session and, until that is a whole one, of the session before. In: batches of this session, and
// what is wanted. Out: pictures of one of both. They are not mixed: the server knows nothing of what is held of before,
// and would let it stay where it is wrong by now.
#pragma once

#include <memory>
#include <vector>

#include "client/core/picture/picture_maker.h"

namespace framelet {

class SessionPictures {
public:
    /// What batches of this view go into; nothing is held in it where `held_since` is another than last time.
    PictureMaker& prepare(NumberedView const& wanted, PictureSettings const& settings);
    /// Null before that, in this session.
    PictureMaker const* current() const { return current_.get(); }
    /// Whether that is for this view.
    bool is_for(NumberedView const& view) const { return current_ && since_ == view.held_since; }

    /// This session has ended: what it showed is shown on, at this time of the scene, until one of the next two.
    void pause(SceneTime present);
    /// It goes on.
    void resume() { is_paused_ = false; }
    /// Another one begins, which has sent nothing yet.
    void begin_anew();
    /// What is held of the session before is of another scene.
    void forget_earlier();

    /// As `PictureMaker::show`. The session before shows its own until this one's picture has no more holes, or is
    /// complete: that is seen by making both. After `prepare`.
    bool show(PictureRequest const& request, Picture& picture, std::vector<PixelRect>& changed,
              BlockCanvas* canvas = nullptr);
    /// Whose the picture is. After `prepare`.
    PictureMaker const& shown() const { return earlier_ ? *earlier_ : *current_; }
    std::size_t memory_bytes() const;

private:
    void keep_as_earlier();
    bool replaces_earlier(PictureRequest const& request);

    std::unique_ptr<PictureMaker> current_;
    std::uint64_t since_ = 0; ///< as `held_since` of its views
    std::unique_ptr<PictureMaker> earlier_;
    bool is_paused_ = false;
    SceneTime paused_ = 0; ///< which the earlier one shows
    Picture unseen_; ///< of this session, while the one before is shown
    std::vector<PixelRect> unseen_changes_; ///< scratch
};

} // namespace framelet
