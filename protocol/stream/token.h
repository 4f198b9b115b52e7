// The shared secret that lets a viewer in: how it is made, read and compared. In: a file, or what a peer sent.
// Out: the token, or whether two are the same. Tokens never stand in messages of errors.
#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <string_view>

#include "protocol/messages/message.h"

namespace framelet {

/// The least length of a token, bytes: a shorter one can be guessed.
inline constexpr std::size_t min_token_bytes = 16;

/// Makes a token: 128 bits of the system's randomness, in 32 hexadecimal digits. Throws std::runtime_error where there
/// is none, or no memory for it, as the next does.
std::string make_token();

/// Makes a ticket of as many bits, for one viewer that comes back.
Ticket make_ticket();

/// True when both are the same. Takes a time that depends on their lengths only.
bool same_token(std::string_view left, std::string_view right);

/// The token in a line: what it has between white space. InputError where that is shorter than `min_token_bytes`,
/// longer than 4096 bytes or not UTF-8 text; `what` is for its message.
std::string token_in(std::string line, std::string const& what);

/// Reads a token: the first line of `file` without the white space around it. InputError where the file cannot be read,
/// is a pipe out of which no line comes within `patience`, or the line is empty or none of `token_in`. A program that
/// makes the token needs a moment; one that says nothing would keep a server from starting for good.
std::string read_token_file(std::filesystem::path const& file, std::chrono::seconds patience = std::chrono::seconds(5));

} // namespace framelet
