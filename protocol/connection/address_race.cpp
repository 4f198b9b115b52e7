#include "protocol/connection/address_race.h"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <utility>

namespace framelet {
namespace {

constexpr auto pause_between = std::chrono::milliseconds(250);

} // namespace

std::vector<AddressRace::Tcp::endpoint> alternating(std::vector<AddressRace::Tcp::endpoint> addresses) {
    bool const first_is_v6 = addresses.front().address().is_v6();
    auto const others = std::stable_partition(addresses.begin(), addresses.end(), [&](auto const& address) {
        return address.address().is_v6() == first_is_v6;
    });
    std::vector<AddressRace::Tcp::endpoint> out;
    for (auto a = addresses.begin(), b = others; a != others || b != addresses.end();) {
        if (a != others) {
            out.push_back(*a++);
        }
        if (b != addresses.end()) {
            out.push_back(*b++);
        }
    }
    return out;
}

void AddressRace::start(std::vector<Tcp::endpoint> const& addresses, Handler handler) {
    cancel();
    waiting_ = alternating(addresses);
    std::reverse(waiting_.begin(), waiting_.end());
    handler_ = std::move(handler);
    try_next();
}

void AddressRace::cancel() {
    ++race_;
    next_.cancel();
    waiting_.clear();
    tried_.clear();
}

void AddressRace::try_next() {
    Tcp::endpoint const address = waiting_.back();
    waiting_.pop_back();
    auto const tried = tried_.emplace(tried_.end(), io_);
    tried->async_connect(address, [this, tried, race = race_](Error error) {
        if (race == race_) {
            take_result(tried, error);
        }
    });
    if (waiting_.empty()) {
        next_.cancel();
        return;
    }
    next_.expires_after(pause_between);
    next_.async_wait([this, race = race_](Error error) {
        if (!error && race == race_ && !waiting_.empty()) {
            try_next();
        }
    });
}

void AddressRace::take_result(std::list<Tcp::socket>::iterator tried, Error error) {
    if (error && !waiting_.empty()) {
        tried_.erase(tried);
        try_next();
    } else if (error && tried_.size() > 1) {
        tried_.erase(tried);
    } else {
        Tcp::socket socket = std::move(*tried);
        Handler const handler = std::move(handler_);
        cancel();
        handler(error, std::move(socket));
    }
}

} // namespace framelet
