// A pool's rounds, with workers that answer, are late, leave, or answer what nobody asked.
#include <algorithm>
#include <atomic>
#include <random>
#include <thread>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "tests/workers/answering_worker.h"

namespace framelet {
namespace {

using namespace std::chrono_literals;

/// Orders of one tile each; by its number a chunk is known.
std::vector<PathOrder> orders(std::uint32_t count) {
    std::vector<PathOrder> all(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        all[i].tiles = {{Tile{1}, i}};
    }
    return all;
}

/// The answer of somebody who does what is asked.
PathAnswer answer_to(PathOrder const& order) {
    return {order.number, 100, {static_cast<float>(order.tiles.front().number)}};
}

/// A worker that keeps its orders until the test has it answer. A pool may still be sending when it has gone.
struct KeepingWorker {
    struct Inbox {
        std::mutex mutex;
        std::vector<PathOrder> kept;
        std::string ended;
    };
    std::shared_ptr<Inbox> inbox = std::make_shared<Inbox>();
    std::vector<PathOrder>& kept = inbox->kept;
    std::string& ended = inbox->ended;

    WorkerPool::Worker member(std::size_t threads = 1) const {
        return {threads,
                [inbox = inbox](PathOrder const& order) {
                    std::scoped_lock const lock(inbox->mutex);
                    inbox->kept.push_back(order);
                },
                [inbox = inbox](std::string const& reason) {
                    std::scoped_lock const lock(inbox->mutex);
                    inbox->ended = reason;
                }};
    }
};

/// What became of a round's chunks.
struct Round {
    std::vector<int> here, there;

    explicit Round(std::size_t count) : here(count), there(count) {}
    void finish(WorkerPool& pool, std::chrono::microseconds chunk = 0us) {
        pool.finish(
            [&](std::size_t index) {
                std::this_thread::sleep_for(chunk);
                ++here[index];
            },
            [&](std::size_t index, PathAnswer const& answer) {
                bool const fits = answer.light == std::vector<float>{static_cast<float>(index)};
                there[index] += fits ? 1 : 0;
                return fits;
            });
    }
    /// True where each chunk was done once.
    bool is_done() const {
        for (std::size_t i = 0; i < here.size(); ++i) {
            if (here[i] + there[i] != 1) {
                return false;
            }
        }
        return true;
    }
    int done_there() const { return static_cast<int>(std::count(there.begin(), there.end(), 1)); }
};

/// With one thread of this process's, whatever the machine.
class WorkerPoolTest : public testing::Test {
protected:
    tbb::global_control one{tbb::global_control::max_allowed_parallelism, 1};
};

TEST(WorkerPool, WithoutWorkersThisProcessDoesAll) {
    WorkerPool pool;
    Round round(100);
    pool.begin(orders(100));
    round.finish(pool);
    EXPECT_TRUE(round.is_done());
    EXPECT_EQ(round.done_there(), 0);
}

TEST(WorkerPool, WorkersDoTheirPart) {
    WorkerPool pool;
    AnsweringWorker const one(pool, 1, answer_to), two(pool, 2, answer_to), three(pool, 3, answer_to);
    for (int i = 0; i < 20; ++i) {
        Round round(60);
        pool.begin(orders(60));
        round.finish(pool, 200us);
        EXPECT_TRUE(round.is_done());
    }
    EXPECT_GT(pool.paths(), 0u);
}

TEST_F(WorkerPoolTest, AWorkerThatStandsStillOrLeavesCostsNoChunk) {
    WorkerPool pool;
    KeepingWorker stopped;
    pool.join(1, stopped.member(4));
    Round first(20);
    pool.begin(orders(20));
    EXPECT_EQ(stopped.kept.size(), 2u) << "of four threads that it says it has one counts";
    first.finish(pool);
    EXPECT_TRUE(first.is_done());
    EXPECT_EQ(first.done_there(), 0);

    std::this_thread::sleep_for(60ms); // longer than it is taken to need
    EXPECT_EQ(pool.chunks_at_once(), 1u) << "nothing is made for who does not answer";
    Round second(20); // it gets no more until it answers
    pool.begin(orders(20));
    EXPECT_EQ(stopped.kept.size(), 2u);
    second.finish(pool);
    EXPECT_TRUE(second.is_done());

    for (PathOrder const& order : std::vector(stopped.kept)) { // all of them late
        pool.answer(1, answer_to(order));
    }
    EXPECT_EQ(stopped.ended, "");
    Round third(20);
    pool.begin(orders(20));
    EXPECT_EQ(stopped.kept.size(), 4u);
    pool.leave(1);
    third.finish(pool);
    EXPECT_TRUE(third.is_done());
}

TEST_F(WorkerPoolTest, WhatAWorkerLeavesOutIsDoneByOthers) {
    WorkerPool pool;
    KeepingWorker worker;
    pool.join(1, worker.member());
    Round round(5);
    pool.begin(orders(5));
    ASSERT_EQ(worker.kept.size(), 2u) << "one to go on with";
    pool.answer(1, {worker.kept[0].number, 0, {}});
    EXPECT_NE(worker.ended, "") << "given once more, it would keep all waiting";
    EXPECT_EQ(worker.kept.size(), 2u);
    pool.leave(1);
    round.finish(pool);
    EXPECT_TRUE(round.is_done());
}

TEST_F(WorkerPoolTest, AnswersThatNobodyAskedForEndTheirWorker) {
    WorkerPool pool;
    KeepingWorker honest, hostile;
    pool.join(1, honest.member());
    pool.join(2, hostile.member());
    Round round(8);
    pool.begin(orders(8));
    ASSERT_EQ(honest.kept.size(), 2u);
    ASSERT_EQ(hostile.kept.size(), 2u);
    pool.answer(2, answer_to(honest.kept[0])); // the other's order
    EXPECT_NE(hostile.ended, "");
    EXPECT_EQ(honest.ended, "");
    pool.leave(2);
    pool.answer(2, answer_to(hostile.kept[0])); // it is gone
    pool.answer(1, answer_to(honest.kept[0]));
    PathOrder const before = honest.kept[0];
    pool.answer(1, answer_to(before)); // twice
    EXPECT_NE(honest.ended, "");
    round.finish(pool);
    EXPECT_TRUE(round.is_done());
    pool.answer(3, answer_to(before)); // never heard of
}

TEST_F(WorkerPoolTest, WhatIsNoLightEndsItsWorkerAndIsDoneHere) {
    WorkerPool pool;
    KeepingWorker hostile;
    pool.join(1, hostile.member());
    Round round(6);
    pool.begin(orders(6));
    ASSERT_EQ(hostile.kept.size(), 2u);
    pool.answer(1, {hostile.kept[1].number, 0, {-1}});
    round.finish(pool);
    EXPECT_TRUE(round.is_done());
    EXPECT_EQ(round.here[1], 1);
    EXPECT_NE(hostile.ended, "");
}

/// Workers come, leave, and answer in any order, at random, while rounds go on.
TEST(WorkerPool, EveryRoundEndsWhateverWorkersDo) {
    WorkerPool pool;
    std::atomic<bool> ends = false;
    std::vector<std::jthread> workers;
    for (WorkerPool::Id id = 1; id <= 4; ++id) {
        workers.emplace_back([&, id] {
            std::minstd_rand random(static_cast<unsigned>(id));
            while (!ends) {
                KeepingWorker worker;
                pool.join(id, worker.member(1 + random() % 3));
                for (std::size_t steps = random() % 50; steps > 0 && !ends; --steps) {
                    std::unique_lock lock(worker.inbox->mutex);
                    if (worker.kept.empty()) {
                        lock.unlock();
                        std::this_thread::yield();
                        continue;
                    }
                    std::size_t const which = random() % worker.kept.size();
                    PathOrder const order = worker.kept[which];
                    worker.kept.erase(worker.kept.begin() + static_cast<std::ptrdiff_t>(which));
                    lock.unlock();
                    pool.answer(id, random() % 8 == 0 ? PathAnswer{order.number, 0, {}} : answer_to(order));
                }
                pool.leave(id);
            }
        });
    }
    std::minstd_rand random(7);
    for (int i = 0; i < 300; ++i) {
        auto const count = static_cast<std::uint32_t>(random() % 40);
        Round round(count);
        pool.begin(orders(count));
        round.finish(pool, 20us);
        ASSERT_TRUE(round.is_done()) << i;
    }
    ends = true;
}

} // namespace
} // namespace framelet
