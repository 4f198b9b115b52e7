// Bounds the memory that a scene may take once it is decoded. Sizes are reserved here before memory is taken for them,
// by any thread.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <string>

#include "common/error.h"

namespace framelet {

/// Thrown where the scene wants more than its budget. A broken image is left out, this ends the import.
struct SceneTooLarge : InputError {
    using InputError::InputError;
};

class ImportBudget {
public:
    explicit ImportBudget(std::uint64_t bytes) : bytes_(bytes) {}

    ImportBudget(ImportBudget const& other) : bytes_(other.bytes_), taken_(other.taken_.load()) {}
    ImportBudget& operator=(ImportBudget const&) = delete;

    /// Reserves `count` times `bytes_each` bytes. Throws SceneTooLarge where that is more than what is left. Counts may
    /// be whatever a file says.
    void reserve(std::uint64_t count, std::uint64_t bytes_each) {
        bool const fits = bytes_each == 0 || count <= bytes_ / bytes_each;
        if (!fits || taken_.fetch_add(count * bytes_each) + count * bytes_each > bytes_) {
            throw too_large();
        }
    }

    /// Gives back what was reserved for a while.
    void give_back(std::uint64_t bytes) { taken_ -= bytes; }

    /// Bytes that can still be reserved.
    std::uint64_t left() const { return bytes_ - std::min(bytes_, taken_.load()); }

    /// The exception that says so; the caller throws it.
    SceneTooLarge too_large() const {
        return SceneTooLarge("it takes more than " + std::to_string(bytes_ >> 20) +
                             " MB of memory once it is decoded; --scene-memory allows more");
    }

private:
    std::uint64_t bytes_;
    std::atomic<std::uint64_t> taken_{0};
};

} // namespace framelet
