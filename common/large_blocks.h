// Has the C library give back memory once it is freed: framelets, pictures and geometry come in blocks that are taken
// and freed all the time.
#pragma once

#include <cstddef>

namespace framelet {

/// Bytes from which on a block is a large one, such as a square's grid of samples (`MergedSquare`). One below 128 KB
/// still comes from the heap where that has just grown, which is by so much.
inline constexpr std::size_t least_large_block = 64 << 10;

/// Takes each large block from the system by itself and gives it back when it is freed. Left to itself glibc keeps such
/// blocks once one has been freed, between smaller ones, and a program takes twice the memory after a while. For the
/// beginning of `main`; where the library is not glibc, nothing happens.
void give_back_large_blocks();

/// Gives back the pages of free smaller blocks, which the library keeps where others lie behind them. For a program
/// whose blocks come and go for hours, every few seconds; it takes some milliseconds at most, in which whoever wants
/// memory may wait.
void give_back_small_blocks();

} // namespace framelet
