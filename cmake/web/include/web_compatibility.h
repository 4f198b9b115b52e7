// What the project uses of C++20's library that emscripten's libc++ 13 lacks. It is included before each file of the
// web build, and by no other.
#pragma once

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstring>
#include <functional>
#include <iterator>
#include <type_traits>
#include <utility>

namespace std {

template <class To, class From>
To bit_cast(From const& from) {
    static_assert(sizeof(To) == sizeof(From) && is_trivially_copyable_v<To> && is_trivially_copyable_v<From>);
    To to;
    memcpy(&to, &from, sizeof to);
    return to;
}

/// There are no threads that share memory.
template <class Value>
class atomic_ref {
public:
    explicit atomic_ref(Value& value) : value_(value) {}
    void store(Value value, memory_order) const { value_ = value; }

private:
    Value& value_;
};

namespace ranges {

template <class Range, class Test>
bool all_of(Range&& range, Test const& test) {
    return std::all_of(std::begin(range), std::end(range), test);
}
template <class Range, class Test>
bool any_of(Range&& range, Test const& test) {
    return std::any_of(std::begin(range), std::end(range), test);
}
template <class Range, class Test>
bool none_of(Range&& range, Test const& test) {
    return std::none_of(std::begin(range), std::end(range), test);
}
template <class Range, class Visit>
void for_each(Range&& range, Visit const& visit) {
    std::for_each(std::begin(range), std::end(range), visit);
}
template <class Range, class Value>
void fill(Range&& range, Value const& value) {
    std::fill(std::begin(range), std::end(range), value);
}
template <class Range, class Out>
Out copy(Range&& range, Out out) {
    return std::copy(std::begin(range), std::end(range), out);
}
template <class Range, class Test>
auto count_if(Range&& range, Test const& test) {
    return std::count_if(std::begin(range), std::end(range), test);
}
template <class Range, class Value, class Member = std::identity>
auto find(Range&& range, Value const& value, Member const& member = {}) {
    return std::find_if(std::begin(range), std::end(range),
                        [&](auto const& one) { return std::invoke(member, one) == value; });
}
template <class Range, class Test>
auto find_if(Range&& range, Test const& test) {
    return std::find_if(std::begin(range), std::end(range), test);
}
template <class Range, class Order = std::less<>>
auto min_element(Range&& range, Order const& order = {}) {
    return std::min_element(std::begin(range), std::end(range), order);
}
template <class Range, class Order = std::less<>>
void sort(Range&& range, Order const& order = {}) {
    std::sort(std::begin(range), std::end(range), order);
}
template <class Range>
auto adjacent_find(Range&& range) {
    return std::adjacent_find(std::begin(range), std::end(range));
}
template <class Range, class Value>
auto lower_bound(Range&& range, Value const& value) {
    return std::lower_bound(std::begin(range), std::end(range), value);
}
template <class Range, class Out, class Function>
void transform(Range&& range, Out out, Function const& function) {
    std::transform(std::begin(range), std::end(range), out, function);
}

} // namespace ranges
} // namespace std
