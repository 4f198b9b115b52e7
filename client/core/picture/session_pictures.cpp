#include "client/core/picture/session_pictures.h"

#include <utility>

#include "common/error.h"

namespace framelet {

PictureMaker& SessionPictures::prepare(NumberedView const& wanted, PictureSettings const& settings) {
    if (!is_for(wanted)) {
        if (is_paused_) { // nothing comes for the new viewport yet
            keep_as_earlier();
        }
        current_ = std::make_unique<PictureMaker>(wanted.viewport, settings);
        since_ = wanted.held_since;
    }
    current_->set(settings);
    if (earlier_) {
        earlier_->set(settings);
    }
    return *current_;
}

void SessionPictures::pause(SceneTime present) {
    is_paused_ = true;
    paused_ = present;
}

void SessionPictures::begin_anew() {
    is_paused_ = false;
    keep_as_earlier();
}

void SessionPictures::keep_as_earlier() {
    bool const is_other = current_ && earlier_ && current_->viewport() != earlier_->viewport();
    if (current_ && !current_->is_empty() && (!earlier_ || is_other)) {
        earlier_ = std::move(current_);
    }
    current_.reset();
}

void SessionPictures::forget_earlier() {
    earlier_.reset();
    unseen_ = {};
}

bool SessionPictures::replaces_earlier(PictureRequest const& request) {
    if (current_->viewport() != earlier_->viewport()) {
        return !current_->is_empty();
    }
    current_->show(request, unseen_, unseen_changes_);
    return !current_->is_empty() && (request.is_settled || current_->coverage() >= earlier_->coverage());
}

bool SessionPictures::show(PictureRequest const& request, Picture& picture, std::vector<PixelRect>& changed,
                           BlockCanvas* canvas) {
    FRAMELET_CHECK(current_ != nullptr);
    if (earlier_ && replaces_earlier(request)) {
        forget_earlier();
    }
    if (!earlier_) {
        return current_->show(request, picture, changed, canvas);
    }
    PictureRequest paused = request;
    paused.present = paused_;
    return earlier_->show(paused, picture, changed, canvas);
}

std::size_t SessionPictures::memory_bytes() const {
    return (current_ ? current_->memory_bytes() : 0) + (earlier_ ? earlier_->memory_bytes() : 0) + unseen_.rgba.size();
}

} // namespace framelet
