// Where framelet-client puts what it shows: files, a video, another program. In: one picture a display frame.
#pragma once

#include <string>

#include "common/image.h"

namespace framelet {

struct ShownFrame {
    Picture const& picture;
    bool changed; ///< differs from the frame before
    bool chosen; ///< by --output-times
    double seconds; ///< since the run began, when it was shown
};

class FrameSink {
public:
    FrameSink() = default;
    virtual ~FrameSink() = default;
    FrameSink(FrameSink const&) = delete;
    FrameSink& operator=(FrameSink const&) = delete;

    /// Throws InputError once writing has failed.
    virtual void show(ShownFrame const& frame) = 0;
    /// Waits until everything is written; nothing may be shown afterwards. Throws InputError where writing failed.
    virtual void finish() = 0;
    /// After `finish`: a line for people about what was written; empty where the names of the files say it all.
    virtual std::string result() const { return {}; }
    /// Nobody takes any more, for this reason, which is no failure; empty while somebody does.
    virtual std::string end_reason() const { return {}; }
    /// What its threads have cost so far. From any thread.
    virtual double cpu_seconds() const = 0;
};

} // namespace framelet
