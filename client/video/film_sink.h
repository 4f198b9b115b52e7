// Writes what framelet-client shows as a film. In: frames. Out: a file, written when the run is over as long as there
// is room to keep the pictures, so that nothing is taken from what is shown.
#pragma once

#include <filesystem>
#include <optional>

#include "client/frames/frame_sink.h"
#include "client/video/recorder.h"
#include "common/camera.h"

namespace framelet {

class FilmSink : public FrameSink {
public:
    /// Makes the folder where there is none. Throws InputError, also where such a film cannot be written.
    FilmSink(std::filesystem::path const& file, Viewport size);

    void show(ShownFrame const& frame) override;
    void finish() override;
    std::string result() const override { return result_text(recorder_.progress(), recorder_.path()); }
    double cpu_seconds() const override { return recorder_.cpu_seconds(); }

private:
    void throw_if_failed() const;

    Recorder recorder_;
    std::optional<double> begin_; ///< when the first picture was shown: until then there is nothing to see
    double seconds_ = 0; ///< when the newest frame was shown, since `begin_`
};

} // namespace framelet
