// Lets memory run out in single parts that use a library: each throws, and none takes the program along.
#include <algorithm>
#include <atomic>
#include <exception>
#include <filesystem>
#include <span>
#include <thread>

#include <gtest/gtest.h>

#include "common/error.h"
#include "common/files/picture_writer.h"
#include "common/files/png_reader.h"
#include "protocol/codec/zstd_frames.h"
#include "protocol/stream/tls.h"
#include "protocol/stream/token.h"
#include "server/session/scene_reloader.h"
#include "tests/faults/failing_allocations.h"
#include "tests/loopback/process.h"

namespace framelet::test {
namespace {

/// Does the work with each of its allocations failing in turn, until none does. Returns how often it threw. What it
/// does where it does not throw is its own to check.
template <typename Work>
int times_thrown(Work const& work) {
    int thrown = 0;
    for (std::uint64_t number = 1;; ++number) {
        FailingAllocation const fails(number);
        try {
            work();
        } catch (std::exception const&) {
            ++thrown;
        }
        if (!fails.has_failed()) {
            return thrown;
        }
    }
}

TEST(PartAllocation, Compression) {
    std::vector<std::uint8_t> content(40'000);
    for (std::size_t i = 0; i < content.size(); ++i) {
        content[i] = static_cast<std::uint8_t>(i * i / 7);
    }
    Bytes whole;
    FrameCodec().compress(content, whole);
    EXPECT_GT(times_thrown([&] {
                  FrameCodec codec;
                  Bytes frame;
                  try {
                      codec.compress(content, frame);
                  } catch (std::bad_alloc const&) {
                      codec.compress(content, frame); // there is memory again
                      EXPECT_EQ(frame, whole);
                      throw;
                  }
                  EXPECT_EQ(frame, whole);
              }),
              2);
    EXPECT_GT(times_thrown([&] {
                  FrameCodec codec;
                  auto const read = codec.decompress(whole);
                  EXPECT_TRUE(std::ranges::equal(read, content));
              }),
              1);
}

TEST(PartAllocation, RandomNumbers) {
    // A thread of its own, since OpenSSL makes what it needs for each thread once.
    int thrown = 0;
    for (std::uint64_t number = 1; number < 200; ++number) {
        std::thread([&] {
            FailingAllocation const fails(number);
            try {
                EXPECT_TRUE(make_ticket());
            } catch (std::exception const&) {
                ++thrown;
            }
        }).join();
    }
    EXPECT_GT(thrown, 1);
    EXPECT_TRUE(make_ticket());
}

TEST(PartAllocation, TlsContexts) {
    EXPECT_GT(times_thrown([] {
                  std::exception_ptr failure;
                  std::thread([&failure] { // which has no memory for errors yet
                      try {
                          make_tls_client_context("", {});
                      } catch (std::exception const&) {
                          failure = std::current_exception();
                      }
                  })
                      .join();
                  if (failure) {
                      std::rethrow_exception(failure);
                  }
              }),
              2);
}

TEST(PartAllocation, PngFiles) {
    TemporaryFolder const folder;
    Picture picture(64, 48);
    for (std::size_t i = 0; i < picture.rgba.size(); ++i) {
        picture.rgba[i] = i % 4 == 3 ? 255 : static_cast<std::uint8_t>(i);
    }
    std::filesystem::path const file = folder.path() / "picture.png";
    EXPECT_GT(times_thrown([&] { write_png(file, picture); }), 2);
    std::string const text = folder.read("picture.png");
    EXPECT_GT(times_thrown([&] {
                  Picture const read = read_png(std::as_bytes(std::span(text)), [](int, int) {});
                  EXPECT_EQ(read, picture);
              }),
              2);
}

TEST(PartAllocation, AReloadThatFailsIsNotTheLast) {
    TemporaryFolder const folder;
    std::string const file = folder.write("scene.obj", "of no account");
    SparedFromFailure const spared; // the reloader's own thread is not
    for (std::uint64_t number = 1; number < 40; ++number) {
        FailingAllocation const fails(number);
        std::atomic<int> loads = 0;
        auto const load = [&](Progress const&) -> std::shared_ptr<LoadedScene> {
            ++loads;
            throw InputError("a file that does not load at all, which a line says");
        };
        SceneReloader reloader(FileWatch{}, {file}, {}, {}, load, [](auto const&) {});
        for (int i = 1; i <= 3; ++i) {
            reloader.ask();
            EXPECT_TRUE(eventually([&] { return loads >= i; }));
        }
    }
}

} // namespace
} // namespace framelet::test
