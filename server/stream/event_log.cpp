#include "server/stream/event_log.h"

#include <bit>
#include <cerrno>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <nlohmann/json.hpp>
#include <sys/stat.h>
#include <unistd.h>

#include "common/error.h"
#include "protocol/messages/message_codec.h"

namespace framelet {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are copied as they are");

constexpr char const* first_line = "framelet events 6";

enum Kind : std::uint8_t {
    viewer = 1,
    camera,
    settings,
    ack,
    clock_changed,
    batch_sent,
    turn,
    learning,
    batch,
    evicted,
    resumed
};

template <class T>
void put(Bytes& out, T const& value) {
    auto const* const bytes = reinterpret_cast<std::byte const*>(&value);
    out.insert(out.end(), bytes, bytes + sizeof(T));
}

/// The rest of a record, read from its front.
class Content {
public:
    Content(ByteView bytes, std::filesystem::path const& file) : bytes_(bytes), file_(file) {}

    template <class T>
    T take() {
        if (bytes_.size() < sizeof(T)) {
            throw InputError("'" + file_.string() + "': a record is too short");
        }
        T value;
        std::memcpy(&value, bytes_.data(), sizeof(T));
        bytes_ = bytes_.subspan(sizeof(T));
        return value;
    }
    template <class M>
    M message() const {
        try {
            return std::get<M>(decode_message(bytes_));
        } catch (std::exception const& error) {
            throw InputError("'" + file_.string() + "': a record holds another message: " + error.what());
        }
    }
    Bytes rest() const { return Bytes(bytes_.begin(), bytes_.end()); }

private:
    ByteView bytes_;
    std::filesystem::path const& file_;
};

template <class M>
Bytes event_content(double seconds, M const& message) {
    Bytes out;
    put(out, seconds);
    append_message(message, out);
    return out;
}

/// Numbers as their bits, so that they are the same again.
nlohmann::ordered_json json_of(LightOptions const& light) {
    nlohmann::ordered_json out{{"method", static_cast<int>(light.method)},
                               {"sun_bits", std::bit_cast<std::uint32_t>(light.sun_degrees)}};
    if (light.lamp_metres) {
        out["lamp_bits"] = std::bit_cast<std::uint32_t>(*light.lamp_metres);
    }
    return out;
}

LightOptions light_of(nlohmann::json const& told) {
    LightOptions light{static_cast<LightMethod>(told.at("method").get<int>()),
                       std::bit_cast<float>(told.at("sun_bits").get<std::uint32_t>()), std::nullopt};
    if (told.contains("lamp_bits")) {
        light.lamp_metres = std::bit_cast<float>(told.at("lamp_bits").get<std::uint32_t>());
    }
    return light;
}

} // namespace

EventLog::EventLog(std::filesystem::path const& file, OnFailure on_failure)
    : file_(file), on_failure_(std::move(on_failure)) {
    int const descriptor = ::open(file.c_str(), O_WRONLY | O_CREAT | O_NONBLOCK | O_CLOEXEC | O_NOCTTY, 0666);
    struct stat found {};
    bool const is_pipe = descriptor >= 0 && ::fstat(descriptor, &found) == 0 && S_ISFIFO(found.st_mode);
    if (!is_pipe && descriptor >= 0) {
        out_.reset(::fdopen(descriptor, "wb"));
    }
    if (!out_) {
        std::string const why = is_pipe || errno == ENXIO ? "it is a pipe" : std::strerror(errno);
        if (descriptor >= 0) {
            ::close(descriptor);
        }
        throw InputError("cannot write '" + file.string() + "': " + why +
                         ": give --record-events a file in a folder that exists");
    }
}

EventLog::~EventLog() {
    if (out_ && std::fflush(out_.get()) != 0) {
        note_failure();
    }
}

void EventLog::begin(ServedScene const& served) {
    nlohmann::ordered_json const line{{"scenes", served.scenes},
                                      {"environment", served.environment},
                                      {"clips", served.clips},
                                      {"light", json_of(served.light)},
                                      {"exposure_bits", std::bit_cast<std::uint32_t>(served.exposure)},
                                      {"tone_curve", static_cast<int>(served.tone_curve)},
                                      {"bias", served.bias},
                                      {"batch_framelets", served.batch_framelets}};
    std::string const text = std::string(first_line) + "\n" + line.dump() + "\n";
    bool const is_cut = ::ftruncate(::fileno(out_.get()), 0) == 0 || errno == EINVAL; // a device has no length
    if (!is_cut || std::fwrite(text.data(), 1, text.size(), out_.get()) != text.size() ||
        std::fflush(out_.get()) != 0) {
        note_failure();
    }
}

void EventLog::note_failure() {
    std::string const why = std::strerror(errno);
    out_.reset();
    on_failure_("cannot write '" + file_.string() + "': " + why + "; what comes from now on is not recorded");
}

void EventLog::write(std::uint64_t session, std::uint8_t kind, Bytes const& content) {
    Bytes bytes;
    put(bytes, kind);
    put(bytes, session);
    put(bytes, static_cast<std::uint32_t>(content.size()));
    bytes.insert(bytes.end(), content.begin(), content.end());
    std::scoped_lock const lock(mutex_);
    if (out_ && std::fwrite(bytes.data(), 1, bytes.size(), out_.get()) != bytes.size()) {
        note_failure();
    }
}

void EventLog::add_viewer(std::uint64_t session, std::uint32_t codings) {
    Bytes content;
    put(content, codings);
    write(session, viewer, content);
}

void EventLog::add_event(std::uint64_t session, StreamEvent const& event) {
    Bytes content;
    if (auto const* const newest = std::get_if<CameraUpdate>(&event.what)) {
        write(session, camera, event_content(event.seconds, *newest));
    } else if (auto const* const wanted = std::get_if<ViewerSettings>(&event.what)) {
        write(session, settings, event_content(event.seconds, *wanted));
    } else if (auto const* const answer = std::get_if<Ack>(&event.what)) {
        write(session, ack, event_content(event.seconds, *answer));
    } else if (auto const* const gone = std::get_if<Evicted>(&event.what)) {
        write(session, evicted, event_content(event.seconds, *gone));
    } else if (auto const* const sent = std::get_if<BatchSent>(&event.what)) {
        put(content, event.seconds);
        put(content, sent->batch);
        put(content, sent->bytes);
        write(session, batch_sent, content);
    } else if (auto const* const back = std::get_if<Resumed>(&event.what)) {
        put(content, event.seconds);
        put(content, back->last_batch);
        write(session, resumed, content);
    } else {
        put(content, event.seconds);
        write(session, clock_changed, content);
    }
}

void EventLog::add_turn(std::uint64_t session, Turn const& given, Step step) {
    Bytes content;
    for (double const number : {given.now, given.present, given.clock_speed, given.samples_per_second,
                                given.plan_seconds, given.pose_seconds}) {
        put(content, number);
    }
    put(content, given.busy_framelets);
    put(content, step);
    write(session, turn, content);
}

void EventLog::add_learning(std::uint64_t session) {
    write(session, learning, {});
}

void EventLog::add_batch(std::uint64_t session, EncodedBatch const& encoded) {
    write(session, batch, encode_message(encoded));
}

EventLogReader::EventLogReader(std::filesystem::path const& file) : file_(file), in_(file, std::ios::binary) {
    std::string line;
    if (!std::getline(in_, line)) {
        throw InputError("cannot read '" + file.string() + "'");
    }
    if (line != first_line || !std::getline(in_, line)) {
        throw InputError("'" + file.string() + "' is no recording of framelet-server --record-events");
    }
    try {
        nlohmann::json const told = nlohmann::json::parse(line);
        served_ = {told.at("scenes"),
                   told.at("environment"),
                   told.at("clips"),
                   light_of(told.at("light")),
                   std::bit_cast<float>(told.at("exposure_bits").get<std::uint32_t>()),
                   told.at("tone_curve"),
                   told.at("bias"),
                   told.at("batch_framelets")};
    } catch (nlohmann::json::exception const& error) {
        throw InputError("'" + file.string() + "' does not say what was served: " + error.what());
    }
}

std::optional<LogRecord> EventLogReader::next() {
    constexpr std::size_t head_bytes = 13;
    Bytes bytes(head_bytes);
    auto const read = [&] {
        in_.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
        return static_cast<std::size_t>(in_.gcount()) == bytes.size();
    };
    if (!read()) {
        return std::nullopt;
    }
    Content head(bytes, file_);
    auto const kind = head.take<std::uint8_t>();
    auto const session = head.take<std::uint64_t>();
    auto const length = head.take<std::uint32_t>();
    if (length > max_message_bytes + sizeof(double)) {
        throw InputError("'" + file_.string() + "': a record is longer than any can be");
    }
    bytes.resize(length);
    if (!read()) {
        return std::nullopt;
    }
    Content content(bytes, file_);
    auto const event = [&](auto const& take_what) {
        auto const seconds = content.take<double>();
        return LogRecord{session, StreamEvent{seconds, take_what()}};
    };
    switch (kind) {
    case viewer:
        return LogRecord{session, ViewerCame{content.take<std::uint32_t>()}};
    case camera:
        return event([&] { return content.message<CameraUpdate>(); });
    case settings:
        return event([&] { return content.message<ViewerSettings>(); });
    case ack:
        return event([&] { return content.message<Ack>(); });
    case evicted:
        return event([&] { return content.message<Evicted>(); });
    case clock_changed:
        return event([&] { return ClockChanged{}; });
    case batch_sent:
        return event([&] {
            auto const number = content.take<std::uint64_t>();
            return BatchSent{number, content.take<std::uint64_t>()};
        });
    case resumed:
        return event([&] { return Resumed{content.take<std::uint64_t>()}; });
    case turn: {
        Turn given;
        for (double* const number : {&given.now, &given.present, &given.clock_speed, &given.samples_per_second,
                                     &given.plan_seconds, &given.pose_seconds}) {
            *number = content.take<double>();
        }
        given.busy_framelets = content.take<std::uint64_t>();
        return LogRecord{session, TurnGiven{given, static_cast<Step>(content.take<std::uint8_t>())}};
    }
    case learning:
        return LogRecord{session, TurnLearnt{}};
    case batch:
        return LogRecord{session, BatchEncoded{content.rest()}};
    default:
        throw InputError("'" + file_.string() + "': a record is of an unknown kind");
    }
}

} // namespace framelet
