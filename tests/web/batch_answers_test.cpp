#include "client/web/batch_answers.h"

#include <gtest/gtest.h>

#include "common/error.h"
#include "protocol/messages/message_codec.h"
#include "protocol/stream/message_frame.h"

namespace framelet {
namespace {

Bytes joined(std::vector<Message> const& messages) {
    Bytes out;
    for (Message const& message : messages) {
        Bytes const frame = frame_of(message);
        out.insert(out.end(), frame.begin(), frame.end());
    }
    return out;
}

EncodedBatch batch(std::uint64_t number, std::size_t bytes = 10) {
    EncodedBatch out;
    out.number = number;
    out.tiles.resize(1);
    out.payload.resize(bytes);
    return out;
}

std::vector<Ack> acks_in(Bytes const& frames) {
    std::vector<Ack> out;
    FrameInbox inbox;
    inbox.add(frames);
    while (auto const body = inbox.next()) {
        out.push_back(std::get<Ack>(decode_message(*body)));
    }
    return out;
}

TEST(FrameInbox, FindsFramesWhereverTheyAreCut) {
    Bytes const bytes = joined({Status{}, Failure{"one"}, batch(7)});
    for (std::size_t size = 1; size < bytes.size(); ++size) {
        FrameInbox inbox;
        std::vector<Message> found;
        for (std::size_t at = 0; at < bytes.size(); at += size) {
            inbox.add(ByteView(bytes).subspan(at, std::min(size, bytes.size() - at)));
            while (auto const body = inbox.next()) {
                found.push_back(decode_message(*body));
            }
        }
        ASSERT_EQ(found.size(), 3u) << size;
        EXPECT_EQ(std::get<Failure>(found[1]).text, "one");
        EXPECT_EQ(std::get<EncodedBatch>(found[2]).number, 7u);
    }
}

TEST(FrameInbox, RefusesLongFramesUntilTheServerHasAnswered) {
    Bytes const bytes = joined({batch(1, max_upstream_message_bytes + 1)});
    FrameInbox inbox;
    inbox.add(bytes);
    EXPECT_THROW(inbox.next(), ProtocolError);
    inbox.take_large();
    EXPECT_TRUE(inbox.next());
    EXPECT_FALSE(inbox.next());
}

TEST(BatchAnswers, AnswersEachBatchOnceItHasEndedAndNothingElse) {
    Bytes const bytes = joined({Welcome{}, batch(1), Status{}, batch(2)});
    BatchAnswers answers;
    EXPECT_EQ(acks_in(answers.answer(ByteView(bytes).first(bytes.size() - 1), 5)), (std::vector<Ack>{{1, 5, 0}}));
    EXPECT_EQ(acks_in(answers.answer(ByteView(bytes).last(1), 6)), (std::vector<Ack>{{2, 6, 0}}));
    EXPECT_TRUE(answers.answer({}, 7).empty());
}

TEST(BatchAnswers, AnswersNothingMoreOnceTheBytesAreWrong) {
    BatchAnswers answers;
    Bytes bytes = joined({batch(1)});
    bytes[4] = std::byte{0xff}; // of the body
    EXPECT_TRUE(answers.answer(bytes, 1).empty());
    EXPECT_TRUE(answers.answer(joined({batch(2)}), 2).empty());
}

} // namespace
} // namespace framelet
