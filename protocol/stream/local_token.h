// The token of a server that was given none: viewers of the same user on the same machine find it by themselves, in a
// file that only this user can read, and other users stay outside. In: addresses. Out: a token. There is one file for
// each address, since a viewer shows its token to whoever listens there: somebody else's program must learn nothing by
// it that opens another server.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace framelet {

/// A fresh token, in files for as long as this lives.
class LocalToken {
public:
    /// Writes a file for each of the addresses, which are written as in "127.0.0.1:7070". Throws InputError where there
    /// is no folder for such a file.
    explicit LocalToken(std::vector<std::string> const& addresses);
    ~LocalToken();
    LocalToken(LocalToken const&) = delete;
    LocalToken& operator=(LocalToken const&) = delete;

    std::string const& token() const { return token_; }

private:
    /// A file of the token, locked while the server lives, so that others can tell which files are of servers that
    /// ended without a word.
    struct File {
        std::filesystem::path path;
        int descriptor;
    };

    bool write(std::filesystem::path const& folder, std::vector<std::string> const& addresses);
    void remove_files();

    std::string const token_;
    std::vector<File> files_;
};

/// The token that the server of this user at that address wrote; empty where there is none.
std::string read_local_token(std::string const& address);

} // namespace framelet
