// The part of the command line that both programs share: where the server is and how to be let in.
#pragma once

#include <string>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

#include "client/server_address.h"
#include "common/camera.h"

namespace framelet {

/// What was written on the command line.
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

/// Throws InputError.
ConnectionOptions make_connection_options(ConnectionArguments const& arguments);

/// Reads WIDTHxHEIGHT. Throws InputError.
Viewport parse_size(std::string const& text);

/// The exit code of a command line that is not to be run: 0 after --help and --version, else 2 and one line on stderr.
int exit_usage(CLI::App const& app, CLI::ParseError const& error);
/// The same for a value that cannot be used.
int exit_usage(CLI::App const& app, std::string const& text);

} // namespace framelet
