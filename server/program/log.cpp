#include "server/program/log.h"

#include <array>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <iostream>
#include <memory>
#include <mutex>
#include <utility>

#include <nlohmann/json.hpp>
#include <poll.h>
#include <spdlog/formatter.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include "common/counted.h"
#include "common/error.h"
#include "common/one_line.h"
#include "common/program_line.h"

namespace framelet {
namespace {

/// The time in UTC, as in 2025-03-01T09:30:00.250Z.
std::string time_text(spdlog::log_clock::time_point time) {
    using namespace std::chrono;
    auto const since = floor<milliseconds>(time.time_since_epoch());
    std::time_t const seconds = floor<std::chrono::seconds>(since).count();
    std::tm parts{};
    ::gmtime_r(&seconds, &parts);
    std::array<char, 32> date{}, fraction{};
    std::strftime(date.data(), date.size(), "%Y-%m-%dT%H:%M:%S", &parts);
    std::snprintf(fraction.data(), fraction.size(), ".%03dZ", static_cast<int>((since % 1s).count()));
    return std::string(date.data()) + fraction.data();
}

class JsonFormatter : public spdlog::formatter {
public:
    void format(spdlog::details::log_msg const& message, spdlog::memory_buf_t& out) override {
        spdlog::string_view_t const level = spdlog::level::to_string_view(message.level);
        std::string const line =
            json_log_line(message.time, {level.data(), level.size()}, {message.payload.data(), message.payload.size()});
        out.append(line.data(), line.data() + line.size());
    }
    std::unique_ptr<spdlog::formatter> clone() const override { return std::make_unique<JsonFormatter>(); }
};

/// Standard error, a printable line at a time, which nobody waits for: while whoever should read it does not, lines are
/// dropped and counted. The loop and the network write them, and would stand still with it.
class UnwaitedSink final : public spdlog::sinks::stderr_color_sink_mt {
public:
    void log(spdlog::details::log_msg const& message) override {
        std::scoped_lock const lock(writing_);
        if (dropped_ > 0 && takes_a_line()) {
            std::string const note = "dropped " + counted(std::exchange(dropped_, 0), "line") + " that nobody read";
            ansicolor_stderr_sink::log({message.time, {}, message.logger_name, spdlog::level::warn, note});
        }
        if (takes_a_line()) {
            std::string const line = to_one_line({message.payload.data(), message.payload.size()});
            ansicolor_stderr_sink::log({message.time, {}, message.logger_name, message.level, line});
        } else {
            ++dropped_;
        }
    }

private:
    /// True where at least 4 KB can be written at once, or an error says that there is nothing to wait for.
    static bool takes_a_line() {
        pollfd out{STDERR_FILENO, POLLOUT, 0};
        return ::poll(&out, 1, 0) != 0;
    }

    std::mutex writing_;
    std::size_t dropped_ = 0;
};

} // namespace

LogFormat parse_log_format(std::string const& text) {
    if (text != "text" && text != "json") {
        throw InputError("a log is text or json, not " + text);
    }
    return text == "json" ? LogFormat::json : LogFormat::text;
}

std::string json_log_line(spdlog::log_clock::time_point time, std::string_view level, std::string_view message) {
    using Json = nlohmann::ordered_json;
    Json const line{{"time", time_text(time)}, {"level", level}, {"message", message}};
    return line.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

void open_log(LogFormat format, bool quiet) {
    spdlog::set_default_logger(std::make_shared<spdlog::logger>("framelet", std::make_shared<UnwaitedSink>()));
    spdlog::set_level(quiet ? spdlog::level::warn : spdlog::level::info);
    if (format == LogFormat::json) {
        spdlog::set_formatter(std::make_unique<JsonFormatter>());
    } else {
        spdlog::set_pattern("%H:%M:%S.%e %^%l%$ %v");
    }
}

void log_end(LogFormat format, std::string_view why) {
    if (format == LogFormat::json) {
        std::cerr << json_log_line(spdlog::log_clock::now(), "error", to_one_line(why));
    } else {
        print_line("framelet-server", why);
    }
}

} // namespace framelet
