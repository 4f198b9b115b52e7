// A session as a file: what came to its stream and when, which turns it was given, and what it answered. In: the calls
// that a loop makes. Out: the same, to be made again (`replay.h`).
//
// The file: "framelet events 6\n", a line of JSON that says what was served, then records: a byte for the kind, the
// session's number (8 bytes), the length of what follows (4), and that. Numbers are little-endian, times doubles; what
// a viewer says and batches are message bodies as on the wire.
#pragma once

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "server/stream/viewer_stream.h"

namespace framelet {

/// The scene that was served, and how.
struct ServedScene {
    std::vector<std::string> scenes; ///< files
    std::string environment; ///< file; empty: the scene's own
    std::vector<Index> clips;
    LightOptions light;
    float exposure = 1;
    ToneCurve tone_curve = ToneCurve::neutral;
    double bias = 0;
    std::uint64_t batch_framelets = 0;
};

/// A viewer has come, and can read `codings`.
struct ViewerCame {
    std::uint32_t codings = 0;
};
struct TurnGiven {
    Turn turn;
    Step step = Step::nothing; ///< what the stream answered
};
/// The batch that was rendered was learnt.
struct TurnLearnt {};
/// The batch that was learnt was encoded: the body of its message.
struct BatchEncoded {
    Bytes body;
};

struct LogRecord {
    std::uint64_t session = 0;
    std::variant<ViewerCame, StreamEvent, TurnGiven, TurnLearnt, BatchEncoded> what;
};

/// All members may be called from any thread, once it has begun.
class EventLog {
public:
    using OnFailure = std::function<void(std::string const&)>;

    /// Opens the file, and leaves it as it is until `begin`. Throws InputError where it cannot be written, or is a
    /// pipe, for whose reader a server would wait. `on_failure` is called once, with a line, where writing fails later,
    /// as on a full disk: nothing more is written then.
    EventLog(std::filesystem::path const& file, OnFailure on_failure);
    ~EventLog();
    EventLog(EventLog const&) = delete;
    EventLog& operator=(EventLog const&) = delete;

    void begin(ServedScene const& served);
    void add_viewer(std::uint64_t session, std::uint32_t codings);
    void add_event(std::uint64_t session, StreamEvent const& event);
    void add_turn(std::uint64_t session, Turn const& turn, Step step);
    void add_learning(std::uint64_t session);
    void add_batch(std::uint64_t session, EncodedBatch const& batch);

private:
    struct Close {
        void operator()(std::FILE* file) const { std::fclose(file); }
    };

    void write(std::uint64_t session, std::uint8_t kind, Bytes const& content);
    void note_failure();

    std::filesystem::path const file_;
    OnFailure const on_failure_;
    std::mutex mutex_;
    std::unique_ptr<std::FILE, Close> out_; ///< null: writing has failed
};

class EventLogReader {
public:
    /// Throws InputError where the file cannot be read or is none of these.
    explicit EventLogReader(std::filesystem::path const& file);

    ServedScene const& served() const { return served_; }
    /// The next record; nothing at the end, or where the last record is not whole. Throws InputError for what cannot be
    /// a record.
    std::optional<LogRecord> next();

private:
    std::filesystem::path const file_;
    std::ifstream in_;
    ServedScene served_;
};

} // namespace framelet
