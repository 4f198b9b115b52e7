// A destination of what framelet-client shows: files, a video, another program. In: one picture a display frame.
#pragma once

#include <string>

#include "common/image.h"

namespace framelet {

struct ShownFrame {
    Picture const& picture;
    bool changed; ///< differs from the frame before
    bool chosen; ///< by --output-times
    double seconds; ///< when it was shown, since the run began
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
    /// A line for people about what was written, once `finish` has returned; empty where the names of the files say it
    /// all.
    virtual std::string result() const { return {}; }
    /// The reason why nobody takes frames any more, which is no failure; empty while somebody does.
    virtual std::string end_reason() const { return {}; }
    /// Processor seconds that its threads have taken so far. May be called from any thread.
    virtual double cpu_seconds() const = 0;
};

} // namespace framelet
