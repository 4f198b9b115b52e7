// Trust on first use: remembers servers whose certificates no authority vouches for, and trusts those that were seen
// before. In: a server's address, the fingerprint of its certificate, and a file with a line for each server. Out:
// whether to go on, and what the user is to be told.
#pragma once

#include <filesystem>
#include <string>

namespace framelet {

struct CertificateVerdict {
    bool is_trusted = false;
    std::string notice; ///< one line; empty: nothing has to be said
};

/// The file of this user; its folder is made. Empty where there can be none.
std::filesystem::path known_servers_file();

/// Judges the certificate of `server`, which is written as in "render.example:7070". `fingerprint` empty: an authority
/// vouches for the certificate, which is remembered too, so that one for which none does is not trusted later. A server
/// that is new is remembered.
CertificateVerdict judge_certificate(std::filesystem::path const& file, std::string const& server,
                                     std::string const& fingerprint);

} // namespace framelet
