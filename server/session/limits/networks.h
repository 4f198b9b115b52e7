// Networks, as `10.0.0.0/8`. In: words of the command line, addresses. Out: whether an address is of one of them.
#pragma once

#include <string>
#include <vector>

#include <boost/asio/ip/address.hpp>
#include <boost/asio/ip/network_v4.hpp>
#include <boost/asio/ip/network_v6.hpp>

namespace framelet {

class Networks {
public:
    /// Adds an address, or a network as ADDRESS/BITS. Throws InputError for other words.
    void add(std::string const& word);
    bool empty() const { return of_v4_.empty() && of_v6_.empty(); }
    /// An IPv4 address counts as such where it came mapped into an IPv6 one, too.
    bool contains(boost::asio::ip::address const& address) const;

private:
    std::vector<boost::asio::ip::network_v4> of_v4_;
    std::vector<boost::asio::ip::network_v6> of_v6_;
};

} // namespace framelet
