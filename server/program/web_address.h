// Where a browser finds the page of a server. In: what it listens on, its token. Out: an address for people; a file
// that takes a browser there.
#pragma once

#include <filesystem>
#include <string>

namespace framelet {

/// The page's address: `endpoint` as in "127.0.0.1:7070". Of all addresses (0.0.0.0, [::]) the machine's name. With the
/// token, which browsers do not send, where that is not empty.
std::string web_address(std::string const& endpoint, bool is_encrypted, std::string const& token);

/// A file of this user alone that leads a browser to an address, which thus is on no command line. It lives as long as
/// this.
class WebAddressFile {
public:
    /// Throws InputError where there is no folder for it.
    explicit WebAddressFile(std::string const& address);
    ~WebAddressFile();
    WebAddressFile(WebAddressFile const&) = delete;
    WebAddressFile& operator=(WebAddressFile const&) = delete;

    std::filesystem::path const& path() const { return path_; }

private:
    std::filesystem::path path_;
};

/// Opens the file with the browser of this desktop, in a process of its own. False where there is no desktop.
bool open_in_browser(std::filesystem::path const& file);

} // namespace framelet
