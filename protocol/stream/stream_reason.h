// Says why a connection ended, in one line for people. In: the error of the socket or of TLS. Out: text.
#pragma once

#include <string>

#include <boost/system/error_code.hpp>
#include <openssl/ssl.h>

namespace framelet {

/// Reason why reading or writing ended. `within_message`: some bytes of a message had arrived when the error came.
std::string stream_reason(boost::system::error_code const& error, bool within_message);

/// Reason why a TLS handshake failed; `ssl` tells what was wrong with the certificate.
std::string handshake_reason(boost::system::error_code const& error, SSL* ssl);

} // namespace framelet
