// framelet-client --output -: a video on standard output, read as the program behind the pipe reads it; and films.
#include <algorithm>
#include <array>
#include <cmath>
#include <csignal>
#include <fstream>
#include <sstream>
#include <vector>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "client/core/client_core.h"
#include "client/core/picture/picture_maker.h"
#include "client/sheet/sheet_moments.h"
#include "common/files/image_io.h"
#include "tests/loopback/process.h"

namespace framelet::test {
namespace {

using namespace std::chrono_literals;

std::string const scene_file = FRAMELET_SOURCE_DIR "/scenes/vehicle_chase.glb";
constexpr auto patience = 120s;

/// A Y4M video of 8 bits and 4:4:4.
struct Video {
    int width = 0, height = 0;
    std::string rate;
    std::vector<std::string> pictures; ///< planes Y, Cb, Cr of each
};

Video parse_video(std::string const& bytes) {
    Video out;
    std::size_t at = bytes.find('\n') + 1;
    std::istringstream header(bytes.substr(0, at));
    std::string word;
    EXPECT_TRUE(header >> word && word == "YUV4MPEG2") << bytes.substr(0, 100);
    while (header >> word) {
        std::string const value = word.substr(1);
        switch (word[0]) {
        case 'W':
            out.width = std::stoi(value);
            break;
        case 'H':
            out.height = std::stoi(value);
            break;
        case 'F':
            out.rate = value;
            break;
        case 'C':
            EXPECT_EQ(value, "444");
            break;
        default:
            break;
        }
    }
    std::string const mark = "FRAME\n";
    std::size_t const length = 3 * static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height);
    while (at + mark.size() + length <= bytes.size()) {
        EXPECT_EQ(bytes.compare(at, mark.size(), mark), 0) << at;
        out.pictures.push_back(bytes.substr(at + mark.size(), length));
        at += mark.size() + length;
    }
    EXPECT_EQ(at, bytes.size()) << "a picture that is not whole";
    return out;
}

/// Red, green and blue of a pixel in BT.601, clamped.
std::array<double, 3> colour(Video const& video, std::string const& picture, int x, int y) {
    std::size_t const plane = static_cast<std::size_t>(video.width) * static_cast<std::size_t>(video.height);
    std::size_t const at = static_cast<std::size_t>(y * video.width + x);
    auto const byte = [&](std::size_t of) { return static_cast<std::uint8_t>(picture[of * plane + at]); };
    double const luma = 255.0 / 219 * (byte(0) - 16);
    double const blue = 255.0 / 224 * (byte(1) - 128), red = 255.0 / 224 * (byte(2) - 128);
    std::array<double, 3> out{luma + 1.402 * red, luma - 0.344136 * blue - 0.714136 * red, luma + 1.772 * blue};
    for (double& value : out) {
        value = std::clamp(value, 0.0, 255.0);
    }
    return out;
}

TEST(Video, IsWhatWasShownAtAConstantRate) {
    ServerProcess server(scene_file, {"--paused", "--exposure", "0"});
    Process video(FRAMELET_CLIENT,
                  {server.address(), "--size", "131x97", "--duration", "3", "--rate", "25", "--output", "-", "--json"});
    ASSERT_EQ(video.wait(patience), 0) << video.errors();
    Video const seen = parse_video(video.output());
    EXPECT_EQ(seen.width, 131);
    EXPECT_EQ(seen.height, 97);
    EXPECT_EQ(seen.rate, "25:1");
    auto const statistics = nlohmann::json::parse(video.errors());
    // The picture that is shown when the time is over may be so by a little less or more than a picture's time.
    EXPECT_NEAR(static_cast<double>(seen.pictures.size()), 25 * statistics.at("seconds").get<double>(), 5);
    ASSERT_GE(seen.pictures.size(), 75u);

    TemporaryFolder folder;
    std::string const file = (folder.path() / "last.png").string();
    Process still(FRAMELET_CLIENT,
                  {server.address(), "--size", "131x97", "--until-converged", "--duration", "100", "--output", file});
    ASSERT_EQ(still.wait(patience), 0) << still.errors();
    Picture const picture = read_picture(file);
    double worst_mean = 0;
    for (int channel = 0; channel < 3; ++channel) {
        double sum = 0;
        for (int y = 0; y < 97; ++y) {
            for (int x = 0; x < 131; ++x) {
                sum += std::abs(colour(seen, seen.pictures.back(), x, y)[static_cast<std::size_t>(channel)] -
                                picture.row(y)[4 * x + channel]);
            }
        }
        worst_mean = std::max(worst_mean, sum / (131 * 97));
    }
    EXPECT_LT(worst_mean, 3) << "levels of 255: two roundings, and what had not been refined yet";
}

TEST(Video, AReaderThatGoesEndsTheClientWithALine) {
    ServerProcess server(scene_file);
    Process piped("/bin/bash", {"-c",
                                "\"$0\" \"$1\" --size 64x64 --duration 100 --output - | head -c 100000 | wc -c; "
                                "echo \"${PIPESTATUS[0]}\"",
                                FRAMELET_CLIENT, server.address()});
    ASSERT_EQ(piped.wait(patience), 0) << piped.errors();
    EXPECT_EQ(piped.output(), "100000\n0\n");
    EXPECT_NE(piped.errors().find("framelet-client: nobody reads the video any more\n"), std::string::npos)
        << piped.errors();
}

TEST(Video, AFilmOfAMovingSceneIsAnAnimation) {
    ServerProcess server(scene_file);
    TemporaryFolder folder;
    std::filesystem::path const file = folder.path() / "made" / "film.webp";
    Process client(FRAMELET_CLIENT,
                   {server.address(), "--size", "160x90", "--duration", "2", "--output", file.string()});
    ASSERT_EQ(client.wait(patience), 0) << client.errors();
    std::ifstream stream(file, std::ios::binary);
    std::string const bytes{std::istreambuf_iterator<char>(stream), {}};
    EXPECT_EQ(bytes.substr(0, 4) + bytes.substr(8, 4), "RIFFWEBP");
    std::size_t const first = bytes.find("ANMF");
    ASSERT_NE(first, std::string::npos) << "one picture, which does not move";
    EXPECT_NE(bytes.find("ANMF", first + 4), std::string::npos);
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(file.parent_path()), {}), 1);
}

TEST(Video, IsNotWrittenToATerminalNorWithTimes) {
    Process terminal("/usr/bin/script",
                     {"-qec", std::string(FRAMELET_CLIENT) + " 127.0.0.1:1 --output -", "/dev/null"});
    EXPECT_EQ(terminal.wait(30s), 2);
    EXPECT_NE(terminal.output().find("is a terminal"), std::string::npos) << terminal.output();
    Process times(FRAMELET_CLIENT, {"127.0.0.1:1", "--output", "-", "--output-times", "1"});
    EXPECT_EQ(times.wait(30s), 2);
    EXPECT_NE(times.errors().find("--output-times"), std::string::npos) << times.errors();
}

TEST(Sheet, HasTheMomentsAsTheyWereShownAndAsTheyAre) {
    ServerProcess server(scene_file);
    TemporaryFolder folder;
    std::string const file = (folder.path() / "new" / "sheet.png").string();
    Process client(FRAMELET_CLIENT,
                   {server.address(), "--size", "96x64", "--duration", "2", "--sheet", file, "--json"});
    ASSERT_EQ(client.wait(patience), 0) << client.errors();
    auto const statistics = nlohmann::json::parse(client.output());
    // The stills are of the same view, a little off; one of another moment, in which cars are elsewhere, is off by much
    // more.
    EXPECT_GT(statistics.at("still_difference").get<double>(), 0);
    EXPECT_LT(statistics.at("still_difference").get<double>(), 0.06);
    Picture const sheet = read_picture(file);
    EXPECT_EQ(sheet.width, 3 * 96 + 2 * 8);
    EXPECT_EQ(sheet.height, 2 * 64 + 8);

    Process again(FRAMELET_CLIENT, {server.address(), "--size", "96x64", "--duration", "1", "--json"});
    ASSERT_EQ(again.wait(patience), 0) << again.errors();
    EXPECT_GT(nlohmann::json::parse(again.output()).at("pictures").get<int>(), 2) << "the clock goes on";
}

/// Of what stands nothing comes for a still: the viewer has it.
TEST(Sheet, StillsAreWholeWhereNothingIsMoved) {
    ServerProcess server(FRAMELET_SOURCE_DIR "/scenes/vehicle_fixed.glb");
    TemporaryFolder folder;
    std::string const file = (folder.path() / "sheet.png").string();
    Process client(FRAMELET_CLIENT,
                   {server.address(), "--size", "640x360", "--duration", "4", "--no-reprojection", "--sheet", file});
    ASSERT_EQ(client.wait(patience), 0) << client.errors();
    Picture const sheet = read_picture(file);
    Picture const bare = bare_picture({1, 1});
    auto is_bare = [&](int x, int y) { return std::equal(bare.rgba.begin(), bare.rgba.end(), sheet.row(y) + 4 * x); };
    std::size_t missing = 0;
    for (int y = 368; y + 1 < sheet.height; ++y) { // below the moments
        for (int x = 0; x + 1 < sheet.width; ++x) {
            // What is missing is whole blocks; a car's paint has a pixel of just this grey now and then.
            missing += is_bare(x, y) && is_bare(x + 1, y) && is_bare(x, y + 1) && is_bare(x + 1, y + 1);
        }
    }
    EXPECT_EQ(missing, 0u);
}

TEST(Sheet, AStillThatTakesLongIsTakenAsItIs) {
    ServerProcess server(scene_file, {"--light", "reference"}); // at rest that is some 65 million paths
    ConnectionOptions options;
    options.server = parse_server_address(server.address());
    ClientCore core(options);
    SheetMoments moments(4, 3s);
    moments.note(1, Picture(320, 200), {core.welcome().start_camera, -1, 0.5});
    moments.take_stills(core);
    EXPECT_EQ(moments.unfinished(), 1);
    Picture const& still = moments.pairs()[0].still;
    EXPECT_EQ(still.width, 320);
    EXPECT_FALSE(std::ranges::all_of(still.rgba, [&](std::uint8_t v) { return v == still.rgba[0] || v == 255; }));
}

TEST(Sheet, NeedsTheClock) {
    ServerProcess server(scene_file);
    Process first(FRAMELET_CLIENT, {server.address(), "--size", "64x64", "--duration", "100"});
    ASSERT_TRUE(eventually([&] { return server.process().errors().find("viewer 1") != std::string::npos; }));
    TemporaryFolder folder;
    std::string const file = (folder.path() / "sheet.png").string();
    Process client(FRAMELET_CLIENT, {server.address(), "--size", "64x64", "--duration", "1", "--sheet", file});
    EXPECT_EQ(client.wait(patience), 1);
    EXPECT_NE(client.errors().find("another viewer controls"), std::string::npos) << client.errors();
    EXPECT_FALSE(std::filesystem::exists(file));
    Process wrong(FRAMELET_CLIENT, {server.address(), "--sheet", "sheet.jpg"});
    EXPECT_EQ(wrong.wait(patience), 2);
}

TEST(Video, ASignalEndsItWhileNobodyReadsThePipe) {
    ServerProcess const server(scene_file, {"--insecure"});
    TemporaryFolder const folder;
    std::string const pipe = (folder.path() / "pipe").string();
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    int const reader = ::open(pipe.c_str(), O_RDWR | O_CLOEXEC); // which reads nothing
    Process client("/bin/sh", {"-c", "exec \"$0\" \"$@\" >'" + pipe + "'", FRAMELET_CLIENT, server.address(), "--size",
                               "320x200", "--duration", "1000", "--output", "-"});
    EXPECT_TRUE(eventually([&] { // it waits for a reader
        int bytes = 0;
        return ::ioctl(reader, FIONREAD, &bytes) == 0 && bytes > 60'000;
    }));
    client.signal(SIGTERM);
    EXPECT_EQ(client.wait(60s), 0) << client.errors();
    ::close(reader);
}

} // namespace
} // namespace framelet::test
