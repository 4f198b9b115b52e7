// Shares rounds of work with other processes: this one's threads and its workers take chunks, until all are done. In:
// orders, workers as they come and go, answers. Out: each chunk done once, here or there, whatever becomes of a worker.
//
// A worker that has left, or is late by its own measure, loses nothing but its own time: this process does its chunks.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "protocol/messages/message.h"

namespace framelet {

class WorkerPool {
public:
    using Id = std::uint64_t;
    using Time = std::chrono::steady_clock::time_point;

    struct Worker {
        std::size_t threads = 1;
        std::function<void(PathOrder const&)> send; ///< may be called on any thread
        std::function<void(std::string const& reason)> end; ///< likewise: it has answered what nobody asked for
    };

    // These may be called from any thread.
    void join(Id id, Worker worker);
    void leave(Id id);
    /// Takes in an answer. A worker that answers what it was not asked, or twice, is ended.
    void answer(Id id, PathAnswer answer);
    std::size_t workers() const;
    /// How many chunks of a round keep this process's threads busy, and those of workers that answer in time.
    std::size_t chunks_at_once() const;
    /// How many paths of light have come from workers, since the beginning.
    std::uint64_t paths() const;

    /// Paths that a chunk is to be of, for the time that it is to take.
    std::size_t paths_a_chunk() const;
    /// Begins a round, of which workers have some at once; there must be none. The pool numbers the orders.
    void begin(std::vector<PathOrder> orders);
    /// Does what is left of the round, on the calling TBB arena, and returns when all of it is done. `here` does a
    /// chunk; `there` takes in its answer, and says whether it is one. Returns the seconds that threads have waited.
    double finish(std::function<void(std::size_t chunk)> const& here,
                  std::function<bool(std::size_t chunk, PathAnswer const&)> const& there);

private:
    enum class State : std::uint8_t { waiting, out, answered, here };
    struct Chunk {
        PathOrder order;
        State state = State::waiting;
        Id worker = 0; ///< that it was sent to last
        Time sent{};
        PathAnswer answer{};
    };
    struct Member {
        Worker worker;
        std::map<std::uint64_t, Time> asked; ///< orders that it has not answered, and when they were sent
        double latency = 0.02; ///< seconds from an order to its answer, about
        std::size_t answers = 0; ///< that were of use
    };
    /// What is to be said once the lock is gone.
    struct Letter {
        std::function<void(PathOrder const&)> send;
        PathOrder order;
    };

    static std::size_t proven_threads(Member const& member, Time now);
    std::size_t all_threads(Time now) const;
    void hand_out(Id id, Member& member, std::vector<Letter>& letters);
    void hand_out_all(std::vector<Letter>& letters);
    static void post(std::vector<Letter> const& letters);
    Chunk* chunk_of(std::uint64_t number);
    void put_back(std::size_t index);
    bool do_one(std::function<void(std::size_t)> const& here,
                std::function<bool(std::size_t, PathAnswer const&)> const& there);
    void take_in(std::unique_lock<std::mutex>& lock, std::function<bool(std::size_t, PathAnswer const&)> const& there);
    void do_here(std::unique_lock<std::mutex>& lock, std::size_t index, std::function<void(std::size_t)> const& here);
    std::size_t late_chunk(Time now, Time& look_again) const;
    void note_path_seconds(PathOrder const& order, double seconds);

    mutable std::mutex mutex_;
    std::condition_variable changed_;
    std::map<Id, Member> members_;
    std::vector<Chunk> chunks_; ///< of this round
    std::uint64_t first_number_ = 1; ///< of this round's orders
    std::deque<std::size_t> waiting_, answered_; ///< chunks
    std::size_t out_ = 0; ///< how many chunks are
    double here_seconds_ = 0.002; ///< that a chunk takes here, about
    double path_seconds_ = 1e-5; ///< that a path takes, about
    double idle_ = 0; ///< seconds that threads have waited, in this round
    std::uint64_t paths_ = 0;
};

} // namespace framelet
