// The part of the command line that both programs share: where the server is and how to be let in.
#pragma once

#include <string>

#include "common/command_line/command_line.h"
#include "protocol/connection/server_address.h"

namespace framelet {

/// The connection options as they were written on the command line.
struct ConnectionArguments {
    std::string server; ///< HOST[:PORT]
    std::string token_file;
    bool tls = false;
    bool insecure = false;
    bool no_reconnect = false;
    std::string authority_file;
};

/// Adds HOST[:PORT], --token-file, --tls, --tls-ca, --insecure and --no-reconnect. The arguments must outlive the
/// parsing.
CLI::Option* add_connection_options(CLI::App& app, ConnectionArguments& arguments);

/// Makes connection options of all arguments but the token, which `read_token` reads. Throws InputError.
ConnectionOptions make_connection_options(ConnectionArguments const& arguments);

/// The token that --token-file has; empty without that option. Throws InputError.
std::string read_token(ConnectionArguments const& arguments);

} // namespace framelet
