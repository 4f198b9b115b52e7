#include "server/session/loop/cycle_recorder.h"

#include <array>
#include <cstdio>
#include <system_error>

#include <spdlog/spdlog.h>

#include "common/command_line/program_failure.h"
#include "common/error.h"
#include "common/files/picture_writer.h"
#include "server/sampling/field/field_picture.h"

namespace framelet {
namespace {

constexpr std::array<std::pair<FieldView, char const*>, 4> views{{{FieldView::tiles, "tiles"},
                                                                  {FieldView::density, "density"},
                                                                  {FieldView::error, "error"},
                                                                  {FieldView::motion, "motion"}}};

} // namespace

CycleRecorder::CycleRecorder(std::filesystem::path folder, double pictures_per_second)
    : folder_(std::move(folder)), picture_period_(1 / pictures_per_second) {
    std::error_code error;
    std::filesystem::create_directories(folder_, error);
    if (!error) {
        lines_.open(folder_ / "cycles.jsonl", std::ios::trunc);
    }
    if (error || !lines_) {
        throw InputError("cannot record into '" + folder_.string() +
                         "': " + (error ? error.message() : "no file can be written there"));
    }
    thread_ = std::thread([this] { run(); });
}

CycleRecorder::~CycleRecorder() {
    {
        std::scoped_lock const lock(mutex_);
        stop_ = true;
    }
    added_.notify_one();
    thread_.join();
}

void CycleRecorder::add(CycleRecord record, AdaptiveRefresh const& refresh, double now) {
    start_ = start_.value_or(now);
    record.seconds = now - *start_;
    bool draw = false;
    {
        std::scoped_lock const lock(mutex_);
        if (failed_) {
            return;
        }
        auto const [next, first] = next_picture_.try_emplace(record.session, now);
        // A plan that the mirror made has no field behind it.
        draw = !drawing_ && now >= next->second && refresh.choices().size() == refresh.field().size();
        drawing_ = drawing_ || draw;
        next->second = draw ? now + picture_period_ : next->second;
    }
    std::optional<Snapshot> snapshot;
    if (draw) {
        snapshot = Snapshot{refresh.field(), refresh.choices(), refresh.cut()};
    }
    {
        std::scoped_lock const lock(mutex_);
        waiting_.push_back({std::move(record), std::move(snapshot)});
    }
    added_.notify_one();
}

void CycleRecorder::run() {
    std::unique_lock lock(mutex_);
    for (;;) {
        added_.wait(lock, [this] { return stop_ || !waiting_.empty(); });
        if (waiting_.empty()) {
            return;
        }
        Entry const entry = std::move(waiting_.front());
        waiting_.pop_front();
        lock.unlock();
        bool failed = false;
        try {
            write(entry);
        } catch (std::exception const& error) { // memory may be missing too
            spdlog::warn("recording ended: {}", failure_text(error));
            failed = true;
        }
        lock.lock();
        drawing_ = drawing_ && !entry.snapshot;
        if (failed) {
            failed_ = true;
            waiting_.clear();
        }
    }
}

void CycleRecorder::write(Entry const& entry) {
    lines_ << to_json_line(entry.record) << '\n';
    if (!lines_.flush()) {
        throw InputError("cannot write '" + (folder_ / "cycles.jsonl").string() + "'");
    }
    if (!entry.snapshot) {
        return;
    }
    Snapshot const& shown = *entry.snapshot;
    for (auto const& [view, name] : views) {
        std::array<char, 80> file;
        std::snprintf(file.data(), file.size(), "%llu-%06llu-%s.png",
                      static_cast<unsigned long long>(entry.record.session),
                      static_cast<unsigned long long>(entry.record.cycle), name);
        write_png(folder_ / file.data(), draw_field(shown.field, shown.choices, shown.cut, view));
    }
}

} // namespace framelet
