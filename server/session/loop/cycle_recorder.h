// Keeps a folder of what the server thought: a line of JSON for each batch of each session, and pictures of the field
// some times a second. In: the scheduler after a batch. Out: cycles.jsonl and <session>-<cycle>-<view>.png, drawn and
// written by a thread of its own.
#pragma once

#include <condition_variable>
#include <deque>
#include <filesystem>
#include <fstream>
#include <map>
#include <mutex>
#include <optional>
#include <thread>

#include "server/stream/cycle_record.h"

namespace framelet {

class CycleRecorder {
public:
    /// Makes the folder where there is none. `pictures_per_second`: most sets of pictures a second, for each session.
    /// Throws InputError where nothing can be written there.
    CycleRecorder(std::filesystem::path folder, double pictures_per_second);
    /// Writes what waits.
    ~CycleRecorder();
    CycleRecorder(CycleRecorder const&) = delete;
    CycleRecorder& operator=(CycleRecorder const&) = delete;

    /// Adds a record, with pictures of `refresh`; `now`: seconds, steady. To be called from the render loop's thread.
    /// Pictures are left out while the last ones are being written; a full disk ends the recording with a warning, not
    /// the server.
    void add(CycleRecord record, AdaptiveRefresh const& refresh, double now);

private:
    struct Snapshot {
        RegionField field;
        Choices choices;
        std::vector<Patch> cut;
    };
    struct Entry {
        CycleRecord record;
        std::optional<Snapshot> snapshot;
    };

    void run();
    void write(Entry const& entry);

    std::filesystem::path const folder_;
    double const picture_period_; ///< seconds
    std::ofstream lines_;
    std::optional<double> start_; ///< when the first record came, seconds
    std::map<std::uint64_t, double> next_picture_; ///< by session, seconds

    std::mutex mutex_; // guards what follows
    std::condition_variable added_;
    std::deque<Entry> waiting_;
    bool drawing_ = false; ///< a snapshot waits or is being written
    bool failed_ = false;
    bool stop_ = false;

    std::thread thread_;
};

} // namespace framelet
