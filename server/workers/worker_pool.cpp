#include "server/workers/worker_pool.h"

#include <algorithm>
#include <utility>

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include "common/laps.h"
#include "server/workers/order_tracing.h"

namespace framelet {
namespace {

using Seconds = std::chrono::duration<double>;

/// What a chunk is to take: much longer than its way, and short beside a batch.
constexpr double chunk_seconds = 0.002;
/// Orders that a thread of a worker has: it goes on with the second while the answer to the first is on its way.
constexpr std::size_t orders_a_thread = 2;
/// Chunks of a round for each thread: with fewer too many would be idle at its end.
constexpr std::size_t chunks_a_thread = 4;
/// A worker is late from so many times its usual time on.
constexpr double late = 2;
constexpr double least_late_seconds = 0.001;

void note(double& mean, double seconds) {
    constexpr double weight = 0.1;
    mean += weight * (seconds - mean);
}

std::size_t threads_here() {
    return tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
}

WorkerPool::Time after(WorkerPool::Time time, double seconds) {
    return time + std::chrono::duration_cast<WorkerPool::Time::duration>(Seconds(seconds));
}

} // namespace

void WorkerPool::join(Id id, Worker worker) {
    std::vector<Letter> letters;
    {
        std::scoped_lock const lock(mutex_);
        Member& member = members_[id];
        member.worker = std::move(worker);
        hand_out(id, member, letters);
    }
    post(letters);
}

void WorkerPool::leave(Id id) {
    std::vector<Letter> letters;
    {
        std::scoped_lock const lock(mutex_);
        auto const found = members_.find(id);
        if (found == members_.end()) {
            return;
        }
        for (auto const& [number, sent] : found->second.asked) {
            Chunk const* const chunk = chunk_of(number);
            if (chunk != nullptr && chunk->state == State::out && chunk->worker == id) {
                put_back(static_cast<std::size_t>(number - first_number_));
            }
        }
        members_.erase(found);
        hand_out_all(letters);
    }
    changed_.notify_all();
    post(letters);
}

void WorkerPool::answer(Id id, PathAnswer answer) {
    std::vector<Letter> letters;
    std::function<void(std::string const&)> end;
    {
        std::scoped_lock const lock(mutex_);
        auto const found = members_.find(id);
        if (found == members_.end()) {
            return; // it was ended a moment ago
        }
        Member& member = found->second;
        auto const asked = member.asked.find(answer.number);
        if (asked == member.asked.end()) {
            end = member.worker.end;
        } else {
            Chunk* const chunk = chunk_of(answer.number);
            constexpr double most_latency = 1;
            bool const is_wanted = chunk != nullptr && chunk->state == State::out && chunk->worker == id;
            auto const index = static_cast<std::size_t>(answer.number - first_number_);
            double const took = Seconds(std::chrono::steady_clock::now() - asked->second).count();
            if (!answer.light.empty()) { // late ones too: else it would always be given up too early
                note(member.latency, std::min(took, most_latency));
            }
            if (is_wanted && answer.light.empty()) { // given again and again, nobody else would come to do it
                put_back(index);
                end = member.worker.end;
            } else if (is_wanted) {
                chunk->answer = std::move(answer);
                chunk->state = State::answered;
                ++member.answers;
                answered_.push_back(index);
                --out_;
            }
            member.asked.erase(asked);
            if (!end) {
                hand_out(id, member, letters);
            }
        }
    }
    changed_.notify_all();
    post(letters);
    if (end) {
        end("the worker answers what it was not asked, or not what it was");
    }
}

std::size_t WorkerPool::workers() const {
    std::scoped_lock const lock(mutex_);
    return members_.size();
}

std::size_t WorkerPool::chunks_at_once() const {
    Time const now = std::chrono::steady_clock::now();
    std::scoped_lock const lock(mutex_);
    std::size_t const threads = all_threads(now);
    return threads == threads_here() ? threads : chunks_a_thread * threads;
}

std::uint64_t WorkerPool::paths() const {
    std::scoped_lock const lock(mutex_);
    return paths_;
}

std::size_t WorkerPool::paths_a_chunk() const {
    std::scoped_lock const lock(mutex_);
    return static_cast<std::size_t>(chunk_seconds / path_seconds_);
}

void WorkerPool::begin(std::vector<PathOrder> orders) {
    std::vector<Letter> letters;
    {
        std::scoped_lock const lock(mutex_);
        first_number_ += chunks_.size();
        chunks_.clear();
        waiting_.clear();
        answered_.clear();
        out_ = 0;
        idle_ = 0;
        for (PathOrder& order : orders) {
            order.number = first_number_ + chunks_.size();
            order.round = first_number_;
            waiting_.push_back(chunks_.size());
            chunks_.push_back({std::move(order)});
        }
        hand_out_all(letters);
    }
    post(letters);
}

double WorkerPool::finish(std::function<void(std::size_t)> const& here,
                          std::function<bool(std::size_t, PathAnswer const&)> const& there) {
    tbb::parallel_for(
        std::size_t{0}, threads_here(),
        [&](std::size_t) {
            while (do_one(here, there)) {
            }
        },
        tbb::simple_partitioner());
    std::scoped_lock const lock(mutex_);
    return idle_;
}

/// Does the next thing that there is to do in this round, or waits for something; false where all is done, or others
/// are at it.
bool WorkerPool::do_one(std::function<void(std::size_t)> const& here,
                        std::function<bool(std::size_t, PathAnswer const&)> const& there) {
    std::unique_lock lock(mutex_);
    if (!answered_.empty()) {
        take_in(lock, there);
        return true;
    }
    if (!waiting_.empty()) {
        std::size_t const index = waiting_.front();
        waiting_.pop_front();
        do_here(lock, index, here);
        return true;
    }
    if (out_ == 0) {
        return false;
    }
    Time const now = std::chrono::steady_clock::now();
    Time look_again{};
    if (std::size_t const index = late_chunk(now, look_again); index < chunks_.size()) {
        --out_;
        do_here(lock, index, here);
        return true;
    }
    changed_.wait_until(lock, look_again);
    idle_ += Seconds(std::chrono::steady_clock::now() - now).count();
    return true;
}

/// The chunk whose worker is late, or else the one that it has the most still to do before, if this process would be
/// sooner; as many as there are chunks: there is none before `look_again`.
std::size_t WorkerPool::late_chunk(Time now, Time& look_again) const {
    std::size_t found = chunks_.size();
    double longest = here_seconds_;
    look_again = after(now, 1);
    for (std::size_t i = 0; i < chunks_.size(); ++i) {
        Chunk const& chunk = chunks_[i];
        if (chunk.state != State::out) {
            continue;
        }
        double const latency = members_.at(chunk.worker).latency;
        double const since = Seconds(now - chunk.sent).count();
        double const most = late * latency + least_late_seconds;
        if (since > most) {
            return i;
        }
        if (latency - since > longest) {
            longest = latency - since;
            found = i;
        }
        look_again = std::min(look_again, after(chunk.sent, most));
    }
    return found;
}

void WorkerPool::do_here(std::unique_lock<std::mutex>& lock, std::size_t index,
                         std::function<void(std::size_t)> const& here) {
    chunks_[index].state = State::here;
    lock.unlock();
    Laps laps;
    here(index);
    double const seconds = laps.lap();
    lock.lock();
    note(here_seconds_, seconds);
    note_path_seconds(chunks_[index].order, seconds);
}

void WorkerPool::take_in(std::unique_lock<std::mutex>& lock,
                         std::function<bool(std::size_t, PathAnswer const&)> const& there) {
    std::size_t const index = answered_.front();
    answered_.pop_front();
    Chunk& chunk = chunks_[index];
    chunk.state = State::here;
    lock.unlock();
    bool const is_light = there(index, chunk.answer);
    lock.lock();
    if (is_light) {
        double const since = Seconds(std::chrono::steady_clock::now() - chunk.sent).count();
        note_path_seconds(chunk.order, std::min(1e-6 * chunk.answer.took_us, since));
        paths_ += count_paths(chunk.order);
        chunk.answer.light = {};
        return;
    }
    chunk.state = State::waiting;
    waiting_.push_front(index);
    auto const found = members_.find(chunk.worker);
    if (found == members_.end()) {
        return;
    }
    auto const end = found->second.worker.end;
    lock.unlock();
    end("the worker answers with what is no light");
    lock.lock();
}

void WorkerPool::note_path_seconds(PathOrder const& order, double seconds) {
    constexpr double least = 1e-7;
    note(path_seconds_, std::max(seconds / static_cast<double>(count_paths(order)), least));
}

/// Gives a worker as much as it is to have: while there is more than all have threads for, orders to go on with. To be
/// called under the lock, as all that follow.
void WorkerPool::hand_out(Id id, Member& member, std::vector<Letter>& letters) {
    Time const now = std::chrono::steady_clock::now();
    std::size_t const threads = all_threads(now), own = proven_threads(member, now);
    while (!waiting_.empty() && member.asked.size() < own * (waiting_.size() > threads ? orders_a_thread : 1)) {
        std::size_t const index = waiting_.front();
        Chunk& chunk = chunks_[index];
        letters.push_back({member.worker.send, chunk.order});
        member.asked[chunk.order.number] = now;
        waiting_.pop_front();
        chunk.state = State::out;
        chunk.worker = id;
        chunk.sent = now;
        ++out_;
    }
}

/// How many threads of a worker count: it has to show by its answers that it has many, and none do while something is
/// late.
std::size_t WorkerPool::proven_threads(Member const& member, Time now) {
    double const most = late * member.latency + least_late_seconds;
    bool const is_late = std::ranges::any_of(
        member.asked, [&](auto const& order) { return Seconds(now - order.second).count() > most; });
    return is_late ? 0 : std::min(member.worker.threads, member.answers + 1);
}

/// This process's threads and those of all workers that count.
std::size_t WorkerPool::all_threads(Time now) const {
    std::size_t threads = threads_here();
    for (auto const& [id, member] : members_) {
        threads += proven_threads(member, now);
    }
    return threads;
}

void WorkerPool::hand_out_all(std::vector<Letter>& letters) {
    for (auto& [id, member] : members_) {
        hand_out(id, member, letters);
    }
}

void WorkerPool::post(std::vector<Letter> const& letters) {
    for (Letter const& letter : letters) {
        letter.send(letter.order);
    }
}

/// The chunk of an order of this round; null: it is of another one.
WorkerPool::Chunk* WorkerPool::chunk_of(std::uint64_t number) {
    return number >= first_number_ && number - first_number_ < chunks_.size()
               ? &chunks_[static_cast<std::size_t>(number - first_number_)]
               : nullptr;
}

/// What is out is to be done by others.
void WorkerPool::put_back(std::size_t index) {
    chunks_[index].state = State::waiting;
    waiting_.push_front(index);
    --out_;
}

} // namespace framelet
