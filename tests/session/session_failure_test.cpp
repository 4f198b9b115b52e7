// Memory that runs out while one viewer is served ends that viewer's session; the others' go on. Allocations of this
// program fail from a size on that a test chooses, which only what serves a large picture asks for.
#include <atomic>
#include <cstdlib>
#include <new>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "raw_viewer.h"
#include "running_server.h"
#include "tests/evaluation/codecs/link_emulator.h"

namespace {

std::atomic<std::size_t> most_bytes_at_once = SIZE_MAX;

void* allocate(std::size_t bytes, std::size_t alignment) {
    void* const memory = bytes > most_bytes_at_once
                             ? nullptr
                             : std::aligned_alloc(alignment, (bytes + alignment) / alignment * alignment);
    if (memory == nullptr) {
        throw std::bad_alloc();
    }
    return memory;
}

/// Apart, since GCC takes `free` for the wrong end of what `new` gave wherever it sees both.
[[gnu::noinline]] void release(void* memory) {
    std::free(memory);
}

} // namespace

void* operator new(std::size_t bytes) {
    return allocate(bytes, alignof(std::max_align_t));
}
void* operator new(std::size_t bytes, std::align_val_t alignment) {
    return allocate(bytes, static_cast<std::size_t>(alignment));
}
void operator delete(void* memory) noexcept {
    release(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
    release(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept {
    release(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
    release(memory);
}

namespace framelet {
namespace {

class ScarceMemory {
public:
    explicit ScarceMemory(std::size_t most) { most_bytes_at_once = most; }
    ~ScarceMemory() { most_bytes_at_once = SIZE_MAX; }
};

CameraUpdate camera_update(std::uint64_t number, Viewport viewport) {
    return {{number, Camera{}, viewport}, -1};
}

/// The parameter is the number of threads: one, few, and so many that a batch is planned before the last one is learnt.
class SessionFailure : public testing::TestWithParam<std::size_t> {
    tbb::global_control const threads_{tbb::global_control::max_allowed_parallelism, GetParam()};

protected:
    /// Expects that `fails` is served until its session ends, and `goes_on` meanwhile and afterwards.
    static void expect_only_one_ends(RawViewer& fails, RawViewer& goes_on) {
        std::atomic<bool> ended = false;
        std::thread other([&] {
            EXPECT_NE(fails.failure().find("memory"), std::string::npos) << "the line says what was missing";
            ended = true;
        });
        std::uint64_t number = 100;
        for (int rounds_after = 0; rounds_after < 5; rounds_after += ended ? 1 : 0) {
            goes_on.send(camera_update(++number, {64, 48}));
            if (!goes_on.watch([&](Message const& message) {
                    auto const* const batch = std::get_if<EncodedBatch>(&message);
                    return batch != nullptr && batch->moment && batch->moment->view.number == number;
                })) {
                ADD_FAILURE() << "both have ended";
                break;
            }
        }
        other.join();
    }
};
INSTANTIATE_TEST_SUITE_P(Threads, SessionFailure, testing::Values(1, 2, 8));

bool is_batch(Message const& message) {
    return std::holds_alternative<EncodedBatch>(message);
}

TEST_P(SessionFailure, WhenItBegins) {
    RunningServer const server({}, moving_scene());
    RawViewer small(server.port());
    small.send(camera_update(1, {64, 48}));
    ASSERT_TRUE(small.watch(is_batch));
    ScarceMemory const scarce(8'000'000); // less than what is kept of the places of a large picture
    RawViewer late(server.port());
    late.send(camera_update(1, {4096, 2048}));
    expect_only_one_ends(late, small);
}

TEST_P(SessionFailure, WhileABatchIsPlanned) {
    RunningServer const server({}, moving_scene());
    RawViewer small(server.port()), large(server.port());
    for (RawViewer* const viewer : {&small, &large}) {
        viewer->send(camera_update(1, {64, 48}));
        ASSERT_TRUE(viewer->watch(is_batch));
    }
    ScarceMemory const scarce(1'500'000); // less than what is kept of the places of a large picture
    large.send(camera_update(2, {4096, 2048}));
    expect_only_one_ends(large, small);
}

TEST_P(SessionFailure, WhileABatchIsEncoded) {
    RunningServer const server({}, moving_scene());
    bench::LinkEmulator const link(server.port(), {.bits_per_second = 0.4e6, .delay_seconds = 0.002});
    RawViewer small(server.port()), large(link.port());
    small.send(camera_update(1, {64, 48}));
    ASSERT_TRUE(small.watch(is_batch));
    // The limit is less than a plane of what the viewer is taken to hold, which comes into being with the first batch
    // that is sent with loss, because the link is slow.
    ScarceMemory const scarce(24'000'000);
    large.send(camera_update(1, {4096, 2048}));
    expect_only_one_ends(large, small);
}

} // namespace
} // namespace framelet
