#include "client/connection_arguments.h"

#include "protocol/stream/token.h"

namespace framelet {

CLI::Option* add_connection_options(CLI::App& app, ConnectionArguments& arguments) {
    app.option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast)->group("Connection");
    CLI::Option* const server =
        app.add_option("HOST[:PORT]", arguments.server,
                       "Where framelet-server listens; without a port at port " + std::to_string(default_port) +
                           ". An IPv6 address needs brackets: [::1]:7070; tls://HOST is as with --tls")
            ->check(readable_by(parse_server_address));
    app.add_option("--token-file", arguments.token_file,
                   "File whose first line is the server's token; not needed on the same machine as the same user")
        ->type_name("FILE");
    app.add_flag(
        "--tls", arguments.tls,
        "Encrypt the connection and check the server's certificate; where no authority vouches for it you are asked, "
        "and from then on it has to be the same");
    app.add_option("--tls-ca", arguments.authority_file,
                   "Certificates (PEM) to trust, none but these, as of a server that signed its own; implies --tls")
        ->type_name("FILE");
    app.add_flag("--insecure", arguments.insecure,
                 "Send the token to another machine without --tls: who is between can read it");
    app.add_flag("--no-reconnect", arguments.no_reconnect,
                 "End when the session is cut off, instead of trying for another until the server is back");
    return server;
}

ConnectionOptions make_connection_options(ConnectionArguments const& arguments) {
    ConnectionOptions out;
    out.server = parse_server_address(arguments.server);
    out.tls = arguments.tls || !arguments.authority_file.empty() || asks_for_tls(arguments.server);
    out.authority_file = arguments.authority_file;
    out.insecure = arguments.insecure;
    out.reconnect = !arguments.no_reconnect;
    return out;
}

std::string read_token(ConnectionArguments const& arguments) {
    return arguments.token_file.empty() ? "" : read_token_file(arguments.token_file);
}

} // namespace framelet
