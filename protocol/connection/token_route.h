// Decides where a token may go. In: how a viewer connects, the address that it has reached. Out: whether the token may
// be sent there.
#pragma once

#include <boost/asio/ip/address.hpp>

#include "protocol/connection/server_address.h"

namespace framelet {

/// True for an address of this machine itself.
inline bool is_loopback(boost::asio::ip::address const& address) {
    using namespace boost::asio::ip;
    if (address.is_v6() && address.to_v6().is_v4_mapped()) {
        return make_address_v4(v4_mapped, address.to_v6()).is_loopback();
    }
    return address.is_loopback();
}

/// False where the user's token would go to another machine in clear, unless the user wants that.
inline bool may_send_token(ConnectionOptions const& options, boost::asio::ip::address const& address) {
    return options.token.empty() || options.tls || options.insecure || is_loopback(address);
}

} // namespace framelet
