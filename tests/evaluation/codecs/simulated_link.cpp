#include "tests/evaluation/codecs/simulated_link.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <utility>

#include <nlohmann/json.hpp>

#include "common/error.h"

namespace framelet::bench {
namespace {

constexpr double packet_bytes = 1500;

/// Pseudo-random number `index`, uniform in [0, 1) (SplitMix64, [Steele 2014]).
double uniform(std::uint64_t seed, std::uint64_t index) {
    std::uint64_t z = seed + (index + 1) * 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

bool is_amount(double value) {
    return std::isfinite(value) && value >= 0;
}

} // namespace

LinkParameters read_link(std::filesystem::path const& file) {
    std::ifstream stream(file);
    try {
        auto const json = nlohmann::json::parse(stream);
        using Pairs = std::vector<std::pair<double, double>>;
        LinkParameters link;
        link.bits_per_second = 1e6 * json.value("megabits", 0.0);
        link.delay_seconds = 1e-3 * json.value("delay_ms", 0.0);
        link.jitter_seconds = 1e-3 * json.value("jitter_ms", 0.0);
        link.loss = json.value("loss", 0.0);
        for (auto const& [begin, megabits] : json.value("steps", Pairs{})) {
            link.rate_steps.push_back({begin, 1e6 * megabits});
        }
        for (auto const& [begin, seconds] : json.value("stalls", Pairs{})) {
            link.stalls.push_back({begin, seconds});
        }
        SimulatedLink const valid(link);
        return link;
    } catch (nlohmann::json::exception const&) {
        throw InputError(file.string() + ": not a link, as tests/evaluation/links has them");
    } catch (InputError const& error) {
        throw InputError(file.string() + ": " + error.what());
    }
}

SimulatedLink::SimulatedLink(LinkParameters parameters) : parameters_(std::move(parameters)) {
    LinkParameters const& p = parameters_;
    if (!is_amount(p.bits_per_second) || !is_amount(p.delay_seconds) || !is_amount(p.jitter_seconds)) {
        throw InputError("link: rate, delay and jitter must be finite and not below 0");
    }
    if (!(p.loss >= 0 && p.loss < 1)) {
        throw InputError("link: the share that is lost must be at least 0 and below 1");
    }
    double earliest = -INFINITY;
    for (Stall const& stall : p.stalls) {
        if (!std::isfinite(stall.begin) || !is_amount(stall.seconds) || stall.begin < earliest) {
            throw InputError("link: stalls must be finite, in order of time and disjoint");
        }
        earliest = stall.begin + stall.seconds;
    }
    earliest = -INFINITY;
    for (RateStep const& step : p.rate_steps) {
        if (!std::isfinite(step.begin) || !is_amount(step.bits_per_second) || step.begin < earliest) {
            throw InputError("link: rate steps must be finite and in order of time");
        }
        earliest = step.begin;
    }
}

double SimulatedLink::rate_at(double time) const {
    double rate = parameters_.bits_per_second;
    for (RateStep const& step : parameters_.rate_steps) {
        rate = step.begin <= time ? step.bits_per_second : rate;
    }
    return rate;
}

bool SimulatedLink::stalled_at(double time) const {
    return std::ranges::any_of(parameters_.stalls, [time](Stall const& stall) {
        return stall.begin <= time && time < stall.begin + stall.seconds;
    });
}

double SimulatedLink::next_change(double time) const {
    double next = INFINITY;
    auto const consider = [&](double change) { next = change > time ? std::min(next, change) : next; };
    for (Stall const& stall : parameters_.stalls) {
        consider(stall.begin);
        consider(stall.begin + stall.seconds);
    }
    for (RateStep const& step : parameters_.rate_steps) {
        consider(step.begin);
    }
    return next;
}

double SimulatedLink::carried_bits(double from, double to) const {
    double bits = 0;
    while (from < to) {
        double const until = std::min(next_change(from), to);
        bits += stalled_at(from) ? 0 : rate_at(from) * (until - from);
        from = until;
    }
    return bits;
}

double SimulatedLink::backlog_bytes(double now) const {
    double bytes = 0;
    for (Waiting const& message : waiting_) {
        if (message.departed > now) {
            bytes += std::max(0.0, message.bytes - carried_bits(message.started, now) / 8);
        }
    }
    return bytes;
}

SimulatedLink::Delivery SimulatedLink::send(double now, std::size_t bytes) {
    while (!waiting_.empty() && waiting_.front().departed <= now) {
        waiting_.pop_front();
    }
    double const started = std::max(now, free_);
    double time = started;
    double bits = 8 * static_cast<double>(bytes);
    for (;;) {
        double const change = next_change(time);
        if (stalled_at(time)) {
            time = change;
            continue;
        }
        double const rate = rate_at(time);
        double const needed = rate > 0 ? bits / rate : 0;
        if (time + needed <= change) {
            time += needed;
            break;
        }
        bits -= rate * (change - time);
        time = change;
    }
    free_ = time;
    waiting_.push_back({started, time, static_cast<double>(bytes)});
    double const jitter = parameters_.jitter_seconds * uniform(parameters_.seed, messages_);
    double const packets = std::ceil(static_cast<double>(bytes) / packet_bytes);
    bool const lost = uniform(~parameters_.seed, messages_++) < 1 - std::pow(1 - parameters_.loss, packets);
    double const again = lost ? 2 * parameters_.delay_seconds : 0;
    last_arrival_ = std::max(last_arrival_, time + parameters_.delay_seconds + jitter + again);
    return {started, time, last_arrival_};
}

} // namespace framelet::bench
