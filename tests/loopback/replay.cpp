#include "tests/loopback/replay.h"

#include <map>
#include <memory>

#include "common/error.h"
#include "protocol/messages/message_codec.h"

namespace framelet {
namespace {

struct Replayed {
    std::unique_ptr<FrameletStream> stream;
    bool sends = false; ///< what was learnt last is to be sent
};

} // namespace

ReplayFigures replay(EventLogReader& log, PosedScene& scene) {
    ServedScene const& served = log.served();
    StreamOptions options;
    options.exposure = served.exposure;
    options.tone_curve = served.tone_curve;
    options.bias = served.bias;
    options.batch_framelets = served.batch_framelets;
    std::map<std::uint64_t, Replayed> sessions;
    ReplayFigures figures;
    std::optional<double> first;
    while (std::optional<LogRecord> const record = log.next()) {
        Replayed& session = sessions[record->session];
        if (auto const* const came = std::get_if<ViewerCame>(&record->what)) {
            session.stream = std::make_unique<FrameletStream>(options, came->codings);
            continue;
        }
        if (!session.stream) {
            throw InputError("the recording tells of a session that has not begun");
        }
        FrameletStream& stream = *session.stream;
        if (auto const* const event = std::get_if<StreamEvent>(&record->what)) {
            stream.take(*event);
        } else if (auto const* const given = std::get_if<TurnGiven>(&record->what)) {
            first = first.value_or(given->turn.now);
            figures.seconds = given->turn.now - *first;
            ++figures.turns;
            Step const step = stream.plan(given->turn, scene);
            if (step != given->step) {
                ++figures.other_steps;
                return figures;
            }
            if (step == Step::render) {
                scene.pose(stream.moment());
                stream.render(scene);
            }
        } else if (std::holds_alternative<TurnLearnt>(record->what)) {
            session.sends = stream.learn(scene);
        } else if (session.sends) {
            Bytes const body = encode_message(stream.encode());
            ++figures.batches;
            figures.bytes += body.size();
            if (body != std::get<BatchEncoded>(record->what).body) {
                figures.first_other = figures.other_batches++ == 0 ? figures.batches : figures.first_other;
            }
        } else {
            ++figures.other_batches;
        }
    }
    return figures;
}

} // namespace framelet
