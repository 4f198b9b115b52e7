// Trust in certificates that no authority vouches for: the user gives it once, and it is remembered. In: a server's
// address, the fingerprint of its certificate, and a file with a line for each server. Out: whether to go on, and what
// the user is to be told or asked.
#pragma once

#include <filesystem>
#include <string>

namespace framelet {

struct CertificateVerdict {
    bool is_trusted = false;
    bool is_unknown = false; ///< nothing is known of the server: `trust_certificate` once the user has said so
    std::string complaint; ///< one line that says why it is not trusted
};

/// The file of this user; its folder is made. Empty where there can be none.
std::filesystem::path known_servers_file();

/// Judges the certificate of `server`, which is written as in "render.example:7070". `fingerprint` empty: an authority
/// vouches for the certificate, which is remembered, so that one for which none does is not trusted later.
CertificateVerdict judge_certificate(std::filesystem::path const& file, std::string const& server,
                                     std::string const& fingerprint);

/// Remembers that the user trusts this certificate of a server of which nothing was known. Throws InputError where it
/// cannot be remembered.
void trust_certificate(std::filesystem::path const& file, std::string const& server, std::string const& fingerprint);

} // namespace framelet
