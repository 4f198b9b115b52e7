// A server's certificate that nobody vouches for and that has not been seen before: its user says whether to trust it.
// In: what was seen of it. Out: the question; what is trusted is remembered.
#pragma once

#include <string>

#include "common/error.h"
#include "protocol/stream/known_servers.h"

namespace framelet {

/// Refuses a connection before anything but the handshake has been sent: no token.
struct UnknownCertificate : ConnectionRefusal {
    UnknownCertificate(std::string const& line, std::string server_name, std::string sha256)
        : ConnectionRefusal(line), server(std::move(server_name)), fingerprint(std::move(sha256)) {}

    std::string server; ///< HOST:PORT
    std::string fingerprint;

    /// Has the certificate trusted from now on. Throws InputError where that cannot be remembered.
    void trust() const { trust_certificate(known_servers_file(), server, fingerprint); }
};

} // namespace framelet
