#include "server/scene/assimp/mesh_header.h"

#include <charconv>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "common/error.h"
#include "common/files/regular_file.h"
#include "server/scene/reading/file_ending.h"

namespace framelet {
namespace {

/// Least bytes that an element takes: a vertex has three numbers, which take a byte each at least.
constexpr std::uintmax_t least_element_bytes = 3;

void check_count(std::string const& count, std::uintmax_t file_bytes) {
    std::uintmax_t value = 0;
    auto const [end, error] = std::from_chars(count.data(), count.data() + count.size(), value);
    bool const too_long = error == std::errc::result_out_of_range;
    if (too_long || (error == std::errc() && value > file_bytes / least_element_bytes)) {
        throw InputError("its header promises " + count + " elements, more than its " + std::to_string(file_bytes) +
                         " bytes can hold");
    }
}

/// The words of the file's next line that is not a comment; none at the end of the file.
std::vector<std::string> next_words(std::istream& in) {
    char line[4096]; // longer ones are no header's
    std::vector<std::string> words;
    while (words.empty() && in.getline(line, sizeof(line))) {
        std::string const content(line);
        std::istringstream text(content.substr(0, content.find('#')));
        for (std::string word; text >> word;) {
            words.push_back(word);
        }
    }
    return words;
}

/// Checks an .off file: "OFF", then the numbers of vertices, faces and edges, on the same line or the next.
void check_off(std::istream& in, std::uintmax_t file_bytes) {
    std::size_t counts = 0;
    for (auto words = next_words(in); !words.empty() && counts < 3; words = next_words(in)) {
        for (std::size_t i = 0; i < words.size() && counts < 3; ++i) {
            bool const is_count = words[i].find_first_not_of("0123456789") == std::string::npos;
            counts += is_count;
            if (is_count) {
                check_count(words[i], file_bytes);
            }
        }
    }
}

} // namespace

void check_mesh_header(std::filesystem::path const& file) {
    if (lower_extension(file) == ".off") {
        RegularFile const opened(file);
        std::ifstream in(opened.name(), std::ios::binary);
        check_off(in, opened.bytes());
    }
}

} // namespace framelet
