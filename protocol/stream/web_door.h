// What a server's port answers to browsers: the files of its page, and whether a page may open a session. In: a
// request, and how it came. Out: the answer, or nothing where it asks for a WebSocket that is granted. No sockets.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>

namespace framelet {

/// Most bytes of a request, which has no body.
inline constexpr unsigned most_request_bytes = 8192;

struct WebFile {
    std::string name; ///< as in the address, without "/"
    std::string content, compressed; ///< the second by gzip; empty: there is none
    std::string tag; ///< differs where the content does, with its quotation marks
};

/// The page, in memory, and who may open it.
struct WebPage {
    std::vector<WebFile> files;
    std::string origin; ///< of pages elsewhere that may open sessions, as "https://HOST[:PORT]"; empty: none
};

/// Reads the page's files of a folder, each with its FILE.gz where there is one. Throws InputError where there is no
/// index.html.
WebPage read_web_page(std::filesystem::path const& folder);

using WebRequest = boost::beast::http::request<boost::beast::http::empty_body>;
using WebResponse = boost::beast::http::response<boost::beast::http::string_body>;

/// `on_loopback`: the request came by an address that only this machine can reach. There a name that is not this
/// machine's is refused: another site's name may have been made to stand for it (DNS rebinding).
std::optional<WebResponse> web_answer(WebRequest const& request, WebPage const& page, bool on_loopback);
/// The answer to what is no request, or too long a one.
WebResponse bad_request_answer();

} // namespace framelet
