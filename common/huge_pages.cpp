// A program that links this has large blocks in huge pages where the system gives them to those who ask: a page that is
// touched first costs microseconds, and pictures and geometry come in blocks of megabytes that are touched once. glibc
// does the same, but only if its environment says so when the program starts (glibc.malloc.hugetlb=1).
#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>

#include <sys/mman.h>

namespace {

void ask_for_huge_pages([[maybe_unused]] void* memory, [[maybe_unused]] std::size_t bytes) {
#ifdef MADV_HUGEPAGE
    constexpr std::size_t page = 4096; // malloc's own words stand before the block
    if (std::align(page, page, memory, bytes) != nullptr) {
        ::madvise(memory, bytes / page * page, MADV_HUGEPAGE); // refused: the pages are small ones
    }
#endif
}

} // namespace

void* operator new(std::size_t bytes) {
    constexpr std::size_t huge_page = 2 << 20;
    for (;;) {
        if (void* const memory = std::malloc(bytes > 0 ? bytes : 1)) {
            if (bytes >= huge_page) {
                ask_for_huge_pages(memory, bytes);
            }
            return memory;
        }
        std::new_handler const handler = std::get_new_handler();
        if (handler == nullptr) {
            throw std::bad_alloc();
        }
        handler();
    }
}

void operator delete(void* memory) noexcept {
    std::free(memory);
}

void operator delete(void* memory, std::size_t) noexcept {
    std::free(memory);
}
