#include "client/connection_arguments.h"

#include <algorithm>
#include <charconv>
#include <iostream>

#include "common/error.h"
#include "protocol/token.h"

namespace framelet {

CLI::Option* add_connection_options(CLI::App& app, ConnectionArguments& arguments) {
    app.option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
    CLI::Option* const server =
        app.add_option("HOST:PORT", arguments.server,
                       "Where framelet-server listens: HOST, HOST:PORT (else 7070) or [ADDRESS]:PORT for IPv6");
    app.add_option("--token-file", arguments.token_file,
                   "File whose first line is the server's token; not needed on the same machine as the same user");
    app.add_flag(
        "--tls", arguments.tls,
        "Encrypt the connection and check the server's certificate; where no authority vouches for it, that it is "
        "the one of the first time");
    app.add_option("--tls-ca", arguments.authority_file,
                   "Certificates (PEM) to trust, none but these, as of a server that signed its own; implies --tls");
    app.add_flag("--insecure", arguments.insecure,
                 "Send the token to another machine without --tls: who is between can read it");
    app.add_flag("--no-reconnect", arguments.no_reconnect,
                 "End when the session is cut off, instead of trying for another until the server is back");
    return server;
}

ConnectionOptions make_connection_options(ConnectionArguments const& arguments) {
    ConnectionOptions out;
    out.server = parse_server_address(arguments.server);
    if (!arguments.token_file.empty()) {
        out.token = read_token_file(arguments.token_file);
    }
    out.tls = arguments.tls || !arguments.authority_file.empty();
    out.authority_file = arguments.authority_file;
    out.insecure = arguments.insecure;
    out.reconnect = !arguments.no_reconnect;
    return out;
}

Viewport parse_size(std::string const& text) {
    Viewport out;
    char const* const end = text.data() + text.size();
    auto const width = std::from_chars(text.data(), end, out.width);
    bool good = width.ec == std::errc() && width.ptr != end && *width.ptr == 'x';
    if (good) {
        auto const height = std::from_chars(width.ptr + 1, end, out.height);
        good = height.ec == std::errc() && height.ptr == end;
    }
    auto const usable = [](int side) { return side >= 1 && side <= max_viewport_side; };
    if (!good || !usable(out.width) || !usable(out.height)) {
        throw InputError("cannot use \"" + text + "\" as a picture size: write WIDTHxHEIGHT, each 1 to " +
                         std::to_string(max_viewport_side) + ", as in 1280x720");
    }
    return out;
}

int exit_usage(CLI::App const& app, CLI::ParseError const& error) {
    return error.get_exit_code() == 0 ? app.exit(error) : exit_usage(app, error.what());
}

int exit_usage(CLI::App const& app, std::string const& text) {
    std::string line = text;
    std::replace(line.begin(), line.end(), '\n', ' ');
    std::cerr << app.get_name() << ": " << line << " (--help lists the options)\n";
    return 2;
}

} // namespace framelet
