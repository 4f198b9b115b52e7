#include "client/web/batch_answers.h"

#include "common/error.h"
#include "protocol/messages/message_codec.h"
#include "protocol/stream/message_frame.h"

namespace framelet {

Bytes BatchAnswers::answer(ByteView bytes, std::uint64_t received_us) {
    Bytes answers;
    if (is_broken_) {
        return answers;
    }
    try {
        inbox_.add(bytes);
        while (auto const body = inbox_.next()) {
            Message const message = decode_message(*body);
            if (auto const* const batch = std::get_if<EncodedBatch>(&message)) {
                Ack ack{batch->number, 0, 0};
                ack.received_us = received_us;
                Bytes const frame = frame_of(ack);
                answers.insert(answers.end(), frame.begin(), frame.end());
            } else if (std::holds_alternative<Welcome>(message)) {
                inbox_.take_large();
            }
        }
    } catch (ProtocolError const&) {
        is_broken_ = true;
    }
    return answers;
}

} // namespace framelet
