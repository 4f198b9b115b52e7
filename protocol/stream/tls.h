// TLS as a client: whom to believe. In: a connection before its handshake and the name of the host.
#pragma once

#include <string>

#include <openssl/ssl.h>

namespace framelet {

/// Makes the handshake fail unless the certificate is valid and for `host`, a name or an address. InputError where
/// `host` is neither.
void require_host(SSL* ssl, std::string host);

} // namespace framelet
