// Tests what is told of how far an import is, and that whoever is told can end it.
#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "gltf_writer.h"
#include "server/scene/scene_import.h"

namespace framelet {
namespace {

/// Thrown by whoever does not want the scene any more.
struct Unwanted {};

/// A file with much in it: a grid of triangles.
std::string grid_obj(int columns) {
    std::string text;
    for (int y = 0; y <= columns; ++y) {
        for (int x = 0; x <= columns; ++x) {
            text += "v " + std::to_string(x) + " " + std::to_string(y) + " 0\n";
        }
    }
    for (int y = 0; y < columns; ++y) {
        for (int x = 1; x <= columns; ++x) {
            int const corner = y * (columns + 1) + x;
            text += "f " + std::to_string(corner) + " " + std::to_string(corner + 1) + " " +
                    std::to_string(corner + columns + 1) + "\n";
        }
    }
    return text;
}

/// The scene as a .gltf whose buffer is a file of `bytes` beside it.
std::filesystem::path write_with_buffer(TemporaryFolder const& folder, std::size_t bytes) {
    folder.write("a.bin", std::string(bytes, '\0'));
    GltfWriter writer;
    writer.array(triangle_positions, "VEC3");
    std::string const rest = one_mesh(R"("attributes":{"POSITION":0})");
    std::string json = writer.json(rest, false);
    std::string const length = R"("byteLength":)";
    std::size_t const at = json.find(length) + length.size();
    json.replace(at, json.find('}', at) - at, std::to_string(bytes) + R"(,"uri":"a.bin")");
    return folder.write("a.gltf", json);
}

/// The fractions that are told of reading the file.
std::vector<double> reading_of(std::filesystem::path const& file) {
    std::vector<double> fractions;
    import_scene(file, [&](std::string_view what, double fraction) {
        if (what == "reading") {
            fractions.push_back(fraction);
        }
    });
    return fractions;
}

TEST(ImportProgress, LargeFilesAreReadInSeveralSteps) {
    TemporaryFolder const folder;
    constexpr std::size_t megabyte = 1 << 20;
    std::vector<double> const reading = reading_of(write_with_buffer(folder, 40 * megabyte));
    EXPECT_GE(std::ranges::count_if(reading, [](double f) { return f > 0.3 && f < 0.9; }), 3);
}

TEST(ImportProgress, ItBeginsAndEndsAndNeverFallsBack) {
    TemporaryFolder const folder;
    constexpr std::size_t some = 9 << 20;
    for (std::filesystem::path const& file : {write_with_buffer(folder, some), folder.write("a.obj", grid_obj(100)),
                                              std::filesystem::path(FRAMELET_SOURCE_DIR "/scenes/globe.glb")}) {
        std::vector<double> const reading = reading_of(file);
        ASSERT_GE(reading.size(), 2u) << file;
        EXPECT_TRUE(std::ranges::is_sorted(reading)) << file;
        EXPECT_EQ(reading.front(), 0) << file;
        EXPECT_EQ(reading.back(), 1) << file;
    }
}

TEST(ImportProgress, WhoeverIsToldCanEndItAtAnyTime) {
    TemporaryFolder const folder;
    constexpr std::size_t some = 9 << 20;
    for (std::filesystem::path const& file : {write_with_buffer(folder, some), folder.write("a.obj", grid_obj(20)),
                                              std::filesystem::path(FRAMELET_SOURCE_DIR "/scenes/globe.glb")}) {
        int reports = 0;
        import_scene(file, [&](std::string_view, double) { ++reports; });
        EXPECT_GT(reports, 4) << file;
        for (int last = 1; last <= reports; ++last) {
            int told = 0;
            auto const progress = [&](std::string_view, double) {
                if (++told == last) {
                    throw Unwanted();
                }
            };
            EXPECT_THROW(import_scene(file, progress), Unwanted) << file << ", report " << last << " of " << reports;
        }
    }
}

} // namespace
} // namespace framelet
