#include "server/stream/flow/qp_choice.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "common/framelet/framelet.h"

namespace framelet {
namespace {

/// Bytes a sample, about as the codec makes them of a moving picture.
double bytes_of(std::uint8_t qp) {
    return qp == 0 ? 1.15 : 0.6 / (1 + 0.2 * qp);
}

struct Outcome {
    int qp = 0;
    int changes = 0; ///< changes of QP in the second half
};

Outcome outcome_of(double bytes_per_second, double samples_per_second) {
    QpChoice choice;
    LinkState link;
    link.bytes_per_second = bytes_per_second;
    link.bytes_per_sample = bytes_of(0);
    Outcome outcome;
    for (int i = 0; i < 400; ++i) {
        std::uint8_t const qp = choice.choose(link, samples_per_second, 100 + 0.01 * i);
        outcome.changes += i >= 200 && qp != outcome.qp ? 1 : 0;
        outcome.qp = qp;
        link.bytes_per_sample += 0.2 * (bytes_of(qp) - link.bytes_per_sample);
    }
    return outcome;
}

TEST(SentShare, IsThatOfTheLastRays) {
    SentShare share;
    EXPECT_EQ(share.value(), 1) << "all, until more is known";
    share.add(0, 0, 1e6);
    EXPECT_EQ(share.value(), 1);
    for (int i = 0; i < 100; ++i) {
        share.add(1e5, 0.25e5, 1e6);
        EXPECT_GE(share.value(), 0.25);
        EXPECT_LE(share.value(), 1);
    }
    EXPECT_NEAR(share.value(), 0.25, 1e-6);
    share.add(1e9, 0, 1e6);
    EXPECT_NEAR(share.value(), 0, 1e-6) << "all of it was held";
}

TEST(QpChoice, ExactWhereTheLinkTakesIt) {
    EXPECT_EQ(outcome_of(std::numeric_limits<double>::infinity(), 1e7).qp, 0);
    EXPECT_EQ(outcome_of(2e6, 1e6).qp, 0);
}

TEST(QpChoice, AtFirstWithALossUnlessThereIsHardlyALink) {
    LinkState link{.bytes_per_second = std::numeric_limits<double>::infinity(), .bytes_per_sample = 1};
    QpChoice choice;
    int const first = choice.choose(link, 1e7, 7);
    EXPECT_GT(first, 8) << "nobody knows yet what the link carries";
    link.base_seconds = 0.04;
    int qp = first;
    for (int i = 1; i < 50; ++i) {
        qp = choice.choose(link, 1e7, 7 + 0.01 * i);
        EXPECT_TRUE(qp > 0 && qp <= first) << i;
    }
    EXPECT_LT(qp, 8) << "no queue yet";
    EXPECT_EQ(choice.choose(link, 1e7, 7.6), 0);
    QpChoice near;
    near.choose(link, 1e7, 7);
    link.base_seconds = 0.0005;
    EXPECT_EQ(near.choose(link, 1e7, 7.04), 0) << "the first answer came at once";
    QpChoice narrow;
    narrow.choose(link, 1e7, 7);
    link.bytes_per_second = 2e4;
    EXPECT_GE(narrow.choose(link, 1e7, 7.04), first);
}

TEST(QpChoice, CoarserTheSlowerTheLinkAndSteady) {
    int before = 0;
    for (double const rate : {1.0e6, 0.8e6, 0.6e6, 0.45e6, 0.35e6, 0.3e6, 0.1e6, 1.0}) {
        Outcome const outcome = outcome_of(rate, 1e6);
        EXPECT_GE(outcome.qp, before) << rate;
        EXPECT_LE(outcome.changes, 1) << rate;
        before = outcome.qp;
    }
    EXPECT_EQ(before, most_loss);
}

TEST(QpChoice, StepsAreSmallAndItComesBack) {
    QpChoice choice;
    LinkState link{.bytes_per_second = 1e5, .bytes_per_sample = 1};
    int qp = choice.choose(link, 1e6, 1);
    for (int i = 1; i < 100; ++i) {
        int const next = choice.choose(link, 1e6, 1 + 0.001 * i);
        EXPECT_LE(std::abs(next - qp), 2);
        qp = next;
    }
    EXPECT_LT(qp, most_loss) << "in a tenth of a second";
    link.bytes_per_second = 1e8;
    for (int i = 0; i < 100; ++i) {
        qp = choice.choose(link, 1e6, 2 + 0.01 * i);
    }
    EXPECT_EQ(qp, 0);
}

TEST(QpChoice, RateAndBatchAreBounded) {
    LinkState link;
    EXPECT_EQ(bounded_rate(link, 5e6), 5e6);
    EXPECT_EQ(bounded_batch(link), max_batch_framelets);
    link.bytes_per_sample = 0.5;
    link.batch_bytes = 128 * 100;
    EXPECT_EQ(bounded_rate(link, 5e6), 5e6) << "the link is not felt";
    EXPECT_EQ(bounded_batch(link), 100u);
    link.bytes_per_second = 1e6;
    EXPECT_NEAR(bounded_rate(link, 5e6), 2e6, 2e5);
    EXPECT_EQ(worthwhile_seconds(LinkState{}), 0);
    link.batch_bytes = 0;
    EXPECT_EQ(bounded_batch(link), 16u) << "what is worth the head of a batch";
    EXPECT_NEAR(worthwhile_seconds(link), 16 * 128 / 1e6, 1e-9);
    link.bytes_per_second = 1e4;
    EXPECT_EQ(bounded_batch(link), 3u) << "in 50 ms";
    EXPECT_NEAR(worthwhile_seconds(link), 0.05, 1e-9);
    link.bytes_per_second = 1;
    EXPECT_EQ(bounded_batch(link), 1u);
    link.batch_bytes = 1e30;
    EXPECT_EQ(bounded_batch(link), max_batch_framelets);
}

TEST(QpChoice, WhatIsUnchangedIsSentExactlyOnce) {
    ImagePlane const plane({40, 24});
    HeldTiles held(plane);
    std::vector<Tile> const tiles{make_tile(2, 0, 0), make_tile(2, 1, 0), make_tile(4, 8, 4)};
    std::vector<std::uint8_t> needed{1, 0, 1}, qps;
    for (Tile const tile : tiles) {
        held.put(tile, 1, false);
    }
    choose_qps(tiles, needed, 9, -1, held, qps);
    EXPECT_EQ(needed, (std::vector<std::uint8_t>{1, 0, 1}));
    EXPECT_EQ(qps, (std::vector<std::uint8_t>{9, 9}));

    needed = {0, 0, 0};
    choose_qps(tiles, needed, 9, -1, held, qps);
    EXPECT_EQ(needed, (std::vector<std::uint8_t>{1, 0, 1}));
    EXPECT_TRUE(qps.empty()) << "all exact";
    EXPECT_FALSE(held.any_lossy());

    needed = {0, 0, 0};
    choose_qps(tiles, needed, 9, -1, held, qps);
    EXPECT_EQ(needed, (std::vector<std::uint8_t>{0, 0, 0}));
}

TEST(QpChoice, TheFinestOfAStillPictureAreExact) {
    HeldTiles held(ImagePlane({40, 24}));
    std::vector<Tile> const tiles{make_tile(4, 8, 4), make_tile(2, 0, 0), make_tile(4, 8, 0)};
    std::vector<std::uint8_t> needed{1, 1, 1}, qps;
    choose_qps(tiles, needed, 9, held.plane().max_depth(), held, qps);
    EXPECT_EQ(qps, (std::vector<std::uint8_t>{0, 9, 0}));
}

} // namespace
} // namespace framelet
