#include "protocol/stream/web_door.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <string_view>
#include <system_error>
#include <utility>

#include <boost/asio/ip/address.hpp>
#include <boost/beast/core/string.hpp>
#include <boost/beast/http/field.hpp>
#include <boost/beast/websocket/rfc6455.hpp>

#include "common/error.h"

namespace framelet {
namespace {

namespace beast = boost::beast;
namespace http = boost::beast::http;

constexpr std::array<std::pair<std::string_view, char const*>, 5> types{{
    {".html", "text/html; charset=utf-8"},
    {".js", "text/javascript; charset=utf-8"},
    {".css", "text/css; charset=utf-8"},
    {".wasm", "application/wasm"},
    {".svg", "image/svg+xml"},
}};

/// The page loads nothing from elsewhere, and sends nothing there; it may be part of another page, as of a notebook.
constexpr char const* content_policy =
    "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; style-src 'self'; img-src 'self' blob: data:; "
    "connect-src 'self'; worker-src 'self'; base-uri 'none'; form-action 'none'";

char const* type_of(std::string_view name) {
    auto const* const found =
        std::find_if(types.begin(), types.end(), [&](auto const& type) { return name.ends_with(type.first); });
    return found == types.end() ? nullptr : found->second;
}

std::string read_file(std::filesystem::path const& file) {
    std::ifstream in(file, std::ios::binary);
    std::string out{std::istreambuf_iterator<char>(in), {}};
    if (!in) {
        throw InputError("cannot read " + file.string());
    }
    return out;
}

/// 64-bit FNV-1a of the content: it need not keep anybody from making two that are alike.
std::string tag_of(std::string const& content) {
    std::uint64_t hash = 0xcbf29ce484222325;
    for (char const c : content) {
        hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3;
    }
    return '"' + std::to_string(hash) + '"';
}

std::string_view view_of(beast::string_view text) {
    return {text.data(), text.size()};
}

/// The name in "NAME[:PORT]", of IPv6 addresses without brackets.
std::string_view name_in(std::string_view host) {
    if (host.starts_with('[')) {
        return host.substr(1, std::min(host.find(']'), host.size()) - 1);
    }
    return host.substr(0, host.find(':'));
}

/// What an origin says of the host, or nothing.
std::string_view host_in(std::string_view origin) {
    std::size_t const at = origin.find("://");
    return at == origin.npos ? std::string_view() : origin.substr(at + 3);
}

bool equal(std::string_view a, std::string_view b) {
    return beast::iequals({a.data(), a.size()}, {b.data(), b.size()});
}

bool is_this_machine(std::string_view name) {
    constexpr std::string_view local = "localhost";
    boost::system::error_code error;
    auto const address = boost::asio::ip::make_address(std::string(name), error);
    return error ? equal(name, local) || (name.size() > local.size() && name[name.size() - local.size() - 1] == '.' &&
                                          equal(name.substr(name.size() - local.size()), local))
                 : address.is_loopback();
}

bool is_welcome_host(std::string_view host, WebPage const& page, bool on_loopback) {
    return !host.empty() && (!on_loopback || is_this_machine(name_in(host)) || equal(host, host_in(page.origin)));
}

/// Programs other than browsers say no origin.
bool is_welcome_origin(WebRequest const& request, WebPage const& page) {
    auto const found = request.find(http::field::origin);
    if (found == request.end()) {
        return true;
    }
    std::string_view const origin = view_of(found->value());
    std::string_view const host = view_of(request[http::field::host]);
    return (!page.origin.empty() && equal(origin, page.origin)) || equal(origin, "http://" + std::string(host)) ||
           equal(origin, "https://" + std::string(host));
}

WebResponse text_answer(http::status status, std::string text) {
    WebResponse answer{status, 11};
    answer.keep_alive(false);
    answer.set(http::field::content_type, "text/plain; charset=utf-8");
    answer.set("X-Content-Type-Options", "nosniff");
    answer.body() = std::move(text);
    answer.prepare_payload();
    return answer;
}

bool takes_gzip(WebRequest const& request) {
    return view_of(request[http::field::accept_encoding]).find("gzip") != std::string_view::npos;
}

WebResponse file_answer(WebRequest const& request, WebFile const& file) {
    WebResponse answer{http::status::ok, request.version()};
    answer.keep_alive(request.keep_alive());
    answer.set(http::field::content_type, type_of(file.name));
    answer.set("X-Content-Type-Options", "nosniff");
    answer.set("Content-Security-Policy", content_policy);
    answer.set("Referrer-Policy", "no-referrer");
    answer.set(http::field::cache_control, "no-cache"); // asks each time whether it is still the same
    answer.set(http::field::etag, file.tag);
    answer.set(http::field::vary, "Accept-Encoding");
    if (view_of(request[http::field::if_none_match]) == file.tag) {
        answer.result(http::status::not_modified);
        return answer;
    }
    bool const compressed = takes_gzip(request) && !file.compressed.empty();
    std::string const& content = compressed ? file.compressed : file.content;
    if (compressed) {
        answer.set(http::field::content_encoding, "gzip");
    }
    answer.content_length(content.size());
    if (request.method() == http::verb::get) {
        answer.body() = content;
    }
    return answer;
}

} // namespace

WebPage read_web_page(std::filesystem::path const& folder) {
    WebPage page;
    std::error_code error;
    for (auto const& entry : std::filesystem::directory_iterator(folder, error)) {
        std::string const name = entry.path().filename().string();
        if (type_of(name) == nullptr) {
            continue;
        }
        WebFile file{name, read_file(entry.path()), "", ""};
        file.tag = tag_of(file.content);
        std::filesystem::path const compressed = entry.path().string() + ".gz";
        if (std::filesystem::exists(compressed, error)) {
            file.compressed = read_file(compressed);
        }
        page.files.push_back(std::move(file));
    }
    if (std::none_of(page.files.begin(), page.files.end(), [](auto const& f) { return f.name == "index.html"; })) {
        throw InputError("there is no index.html in " + folder.string());
    }
    return page;
}

std::optional<WebResponse> web_answer(WebRequest const& request, WebPage const& page, bool on_loopback) {
    std::string_view const target = view_of(request.target());
    std::string_view name = target.substr(0, target.find('?'));
    name.remove_prefix(name.starts_with('/') ? 1 : 0);
    bool const is_session = name == "session";
    if (is_session && !is_welcome_origin(request, page)) { // whatever the method: an upgrade's answer no page can read
        return text_answer(http::status::forbidden, "pages of that origin may not connect: see --web-origin\n");
    }
    if (request.method() != http::verb::get && request.method() != http::verb::head) {
        WebResponse answer = text_answer(http::status::method_not_allowed, "only GET and HEAD\n");
        answer.set(http::field::allow, "GET, HEAD");
        return answer;
    }
    if (!is_welcome_host(view_of(request[http::field::host]), page, on_loopback)) {
        return text_answer(http::status::forbidden, "this server is not known by that name: use localhost, or "
                                                    "--web-origin\n");
    }
    if (beast::websocket::is_upgrade(request)) {
        return is_session ? std::nullopt : std::optional(text_answer(http::status::not_found, "no such\n"));
    }
    std::string_view const wanted = name.empty() ? "index.html" : name;
    auto const file =
        std::find_if(page.files.begin(), page.files.end(), [&](WebFile const& f) { return f.name == wanted; });
    if (file == page.files.end()) {
        return text_answer(http::status::not_found, "no such\n");
    }
    return file_answer(request, *file);
}

WebResponse bad_request_answer() {
    return text_answer(http::status::bad_request, "no request that this server knows\n");
}

} // namespace framelet
