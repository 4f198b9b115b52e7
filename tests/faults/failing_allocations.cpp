#include "tests/faults/failing_allocations.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <new>
#include <string_view>
#include <utility>

#include <dlfcn.h>
#include <execinfo.h>
#include <link.h>

namespace {

constexpr std::uint64_t never = UINT64_MAX;

std::atomic<std::uint64_t> counted = 0;
std::atomic<std::uint64_t> first_to_fail = never, last_to_fail = never;
std::atomic<std::int64_t> live = 0;
std::atomic<bool> is_suspended = false;
thread_local bool spared = false;

/// Where the code lies of libraries that take memory by malloc and say where it was missing. Others, as glibc's own
/// streams, do not all survive that.
struct Code {
    std::uintptr_t first, last;
};
std::array<Code, 32> by_malloc{};
std::atomic<std::size_t> by_malloc_count = 0;

int note_code(dl_phdr_info* library, std::size_t, void*) {
    std::string_view const name = library->dlpi_name;
    constexpr std::string_view names[] = {"/libzstd.", "/libcrypto.", "/libssl.", "/libpng"};
    bool const counts =
        std::ranges::any_of(names, [&](auto const& part) { return name.find(part) != std::string_view::npos; });
    for (int i = 0; counts && i < library->dlpi_phnum; ++i) {
        auto const& part = library->dlpi_phdr[i];
        if (part.p_type == PT_LOAD && (part.p_flags & PF_X) != 0 && by_malloc_count < by_malloc.size()) {
            std::uintptr_t const first = library->dlpi_addr + part.p_vaddr;
            by_malloc[by_malloc_count++] = {first, first + part.p_memsz};
        }
    }
    return 0;
}

/// True where the call came from such a library.
bool takes_by_malloc(void const* caller) {
    auto const at = reinterpret_cast<std::uintptr_t>(caller);
    return std::any_of(by_malloc.begin(), by_malloc.begin() + by_malloc_count,
                       [&](Code const& code) { return at >= code.first && at < code.last; });
}

/// True where Embree allocates, which does not survive a failure where several threads build.
bool is_for_embree() {
    bool const before = std::exchange(spared, true); // the first backtrace loads a library
    std::array<void*, 64> frames{};
    int const depth = ::backtrace(frames.data(), static_cast<int>(frames.size()));
    bool const found = std::any_of(frames.begin(), frames.begin() + depth, [](void* frame) {
        Dl_info info{};
        return ::dladdr(frame, &info) != 0 && info.dli_fname != nullptr &&
               std::strstr(info.dli_fname, "libembree") != nullptr;
    });
    spared = before;
    return found;
}

bool is_to_fail() {
    if (spared || first_to_fail.load(std::memory_order_relaxed) == never || is_suspended) {
        return false;
    }
    std::uint64_t const number = ++counted;
    if (number < first_to_fail || number > last_to_fail) {
        return false;
    }
    if (is_for_embree()) {
        --counted; // the next allocation is to fail instead
        return false;
    }
    return true;
}

void* allocate(std::size_t bytes, std::size_t alignment) noexcept {
    if (is_to_fail()) {
        return nullptr;
    }
    void* const memory = std::aligned_alloc(alignment, (bytes + alignment) / alignment * alignment);
    live.fetch_add(memory != nullptr ? 1 : 0, std::memory_order_relaxed);
    return memory;
}

void* allocate_or_throw(std::size_t bytes, std::size_t alignment) {
    void* const memory = allocate(bytes, alignment);
    if (memory == nullptr) {
        throw std::bad_alloc();
    }
    return memory;
}

void release(void* memory) noexcept {
    live.fetch_sub(memory != nullptr ? 1 : 0, std::memory_order_relaxed);
    std::free(memory);
}

bool is_to_fail_by_malloc(void const* caller) {
    bool const fails = takes_by_malloc(caller) && is_to_fail();
    if (fails) {
        errno = ENOMEM;
    }
    return fails;
}

} // namespace

// glibc's own, to which what stands in for them goes on.
extern "C" void* __libc_malloc(std::size_t bytes);
extern "C" void* __libc_calloc(std::size_t count, std::size_t bytes);
extern "C" void* __libc_realloc(void* memory, std::size_t bytes);

extern "C" void* malloc(std::size_t bytes) noexcept {
    return is_to_fail_by_malloc(__builtin_return_address(0)) ? nullptr : __libc_malloc(bytes);
}
extern "C" void* calloc(std::size_t count, std::size_t bytes) noexcept {
    return is_to_fail_by_malloc(__builtin_return_address(0)) ? nullptr : __libc_calloc(count, bytes);
}
extern "C" void* realloc(void* memory, std::size_t bytes) noexcept {
    return is_to_fail_by_malloc(__builtin_return_address(0)) ? nullptr : __libc_realloc(memory, bytes);
}

void* operator new(std::size_t bytes) {
    return allocate_or_throw(bytes, alignof(std::max_align_t));
}
void* operator new(std::size_t bytes, std::align_val_t alignment) {
    return allocate_or_throw(bytes, static_cast<std::size_t>(alignment));
}
void* operator new(std::size_t bytes, std::nothrow_t const&) noexcept {
    return allocate(bytes, alignof(std::max_align_t));
}
void* operator new(std::size_t bytes, std::align_val_t alignment, std::nothrow_t const&) noexcept {
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

namespace framelet::test {

FailingAllocation::FailingAllocation(std::uint64_t number, std::uint64_t more) {
    if (by_malloc_count == 0) {
        ::dl_iterate_phdr(note_code, nullptr);
    }
    counted = 0;
    is_suspended = false;
    last_to_fail = number > never - more ? never - 1 : number + more;
    first_to_fail = std::min(number, never - 1);
}

FailingAllocation::~FailingAllocation() {
    first_to_fail = never;
}

bool FailingAllocation::has_failed() const {
    return counted >= first_to_fail;
}

void FailingAllocation::suspend(bool suspended) {
    is_suspended = suspended;
}

std::uint64_t FailingAllocation::count() const {
    return counted;
}

SparedFromFailure::SparedFromFailure() : before_(spared) {
    spared = true;
}

SparedFromFailure::~SparedFromFailure() {
    spared = before_;
}

std::int64_t live_allocations() {
    return live;
}

std::vector<std::uint64_t> sampled_allocations(std::uint64_t count, std::size_t samples) {
    // Each number is some share larger than the last, and by 1 at least.
    std::vector<std::uint64_t> numbers;
    double const share = std::pow(static_cast<double>(count) + 1, 1.5 / static_cast<double>(samples));
    for (double number = 1; number <= static_cast<double>(count);
         number = std::max(number + 1, std::floor(number * share))) {
        numbers.push_back(static_cast<std::uint64_t>(number));
    }
    numbers.push_back(count * 16 + 16);
    return numbers;
}

} // namespace framelet::test
