#include "server/session/limits/networks.h"

#include <algorithm>
#include <charconv>

#include "common/error.h"

namespace framelet {
namespace ip = boost::asio::ip;

void Networks::add(std::string const& word) {
    std::size_t const slash = word.find('/');
    boost::system::error_code error;
    ip::address const address = ip::make_address(word.substr(0, slash), error);
    unsigned const most = address.is_v4() ? 32 : 128;
    unsigned bits = most;
    if (slash != std::string::npos) {
        char const* const end = word.data() + word.size();
        auto const read = std::from_chars(word.data() + slash + 1, end, bits);
        if (read.ec != std::errc() || read.ptr != end) {
            bits = most + 1;
        }
    }
    if (error || bits > most) {
        throw InputError("'" + word + "' is no address or network: give it as 10.0.0.1 or 10.0.0.0/8");
    }
    if (address.is_v4()) {
        of_v4_.emplace_back(address.to_v4(), static_cast<unsigned short>(bits));
    } else {
        of_v6_.emplace_back(address.to_v6(), static_cast<unsigned short>(bits));
    }
}

bool Networks::contains(ip::address const& address) const {
    if (address.is_v6() && address.to_v6().is_v4_mapped()) {
        return contains(ip::make_address_v4(ip::v4_mapped, address.to_v6()));
    }
    // The first addresses of two networks of this length are the same where one is in the other.
    if (address.is_v4()) {
        return std::ranges::any_of(of_v4_, [&](ip::network_v4 const& network) {
            return ip::network_v4(address.to_v4(), network.prefix_length()).network() == network.network();
        });
    }
    return std::ranges::any_of(of_v6_, [&](ip::network_v6 const& network) {
        return ip::network_v6(address.to_v6(), network.prefix_length()).network() == network.network();
    });
}

} // namespace framelet
