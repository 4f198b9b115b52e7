#include "server/stream/event_log.h"

#include <filesystem>
#include <fstream>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "common/error.h"
#include "protocol/messages/message_codec.h"

namespace framelet {
namespace {

struct TemporaryFile {
    std::filesystem::path const path =
        std::filesystem::temp_directory_path() /
        (std::string("event_log_test_") + testing::UnitTest::GetInstance()->current_test_info()->name());
    ~TemporaryFile() { std::filesystem::remove(path); }
};

void fail(std::string const& problem) {
    ADD_FAILURE() << problem;
}

TEST(EventLog, GivesBackWhatWasAdded) {
    TemporaryFile const file;
    ServedScene const served{{"a scene", "another"}, "",   {1, 2}, {LightMethod::reference, 0.1f, 0.7f}, 0.1f,
                             ToneCurve::agx,         -0.5, 7};
    CameraUpdate camera;
    camera.view = {3, {}, {64, 48}};
    EncodedBatch batch;
    batch.number = 4;
    batch.moment->view = camera.view;
    batch.payload = Bytes(5);
    Turn const turn{1.5, 2.5, -0.5, 3e6, 1e-4, 0.25, 7};
    std::vector<StreamEvent> const events{
        {0.1, camera},         {0.2, ViewerSettings{1.5f, -0.25f, false}},
        {0.3, Ack{9, 8, 7}},   {0.4, Evicted{{{4, Tile{5}}, {4, Tile{21}}, {6, Tile{5}}}}},
        {0.5, ClockChanged{}}, {0.6, BatchSent{6, 12345}},
        {0.7, Resumed{5}}};
    {
        EventLog log(file.path, fail);
        log.begin(served);
        log.add_viewer(11, coding::all);
        for (StreamEvent const& event : events) {
            log.add_event(11, event);
        }
        log.add_turn(11, turn, Step::render);
        log.add_learning(11);
        log.add_batch(11, batch);
    }
    EventLogReader reader(file.path);
    EXPECT_EQ(reader.served().scenes, served.scenes);
    EXPECT_EQ(reader.served().clips, served.clips);
    EXPECT_EQ(reader.served().light, served.light);
    EXPECT_EQ(reader.served().exposure, served.exposure);
    EXPECT_EQ(reader.served().tone_curve, served.tone_curve);
    EXPECT_EQ(reader.served().bias, served.bias);
    EXPECT_EQ(reader.served().batch_framelets, served.batch_framelets);
    auto const next = [&] {
        auto const record = reader.next();
        EXPECT_TRUE(record);
        EXPECT_EQ(record->session, 11u);
        return record->what;
    };
    EXPECT_EQ(std::get<ViewerCame>(next()).codings, coding::all);
    for (StreamEvent const& event : events) {
        EXPECT_EQ(std::get<StreamEvent>(next()), event);
    }
    auto const given = std::get<TurnGiven>(next());
    EXPECT_EQ(given.turn, turn);
    EXPECT_EQ(given.step, Step::render);
    EXPECT_TRUE(std::holds_alternative<TurnLearnt>(next()));
    EXPECT_EQ(std::get<BatchEncoded>(next()).body, encode_message(batch));
    EXPECT_FALSE(reader.next());
}

TEST(EventLog, ARecordThatIsNotWholeIsTheEnd) {
    TemporaryFile const file;
    {
        EventLog log(file.path, fail);
        log.begin({});
        log.add_viewer(1, coding::all);
        log.add_turn(1, {}, Step::nothing);
    }
    std::filesystem::resize_file(file.path, std::filesystem::file_size(file.path) - 3);
    EventLogReader reader(file.path);
    EXPECT_TRUE(reader.next());
    EXPECT_FALSE(reader.next());
}

TEST(EventLog, SaysWhereItCannotBeWritten) {
    EXPECT_THROW(EventLog("/nowhere/at all", fail), InputError);
}

TEST(EventLog, IsNoPipeWhoseReaderWouldBeWaitedFor) {
    TemporaryFile const file;
    ASSERT_EQ(::mkfifo(file.path.c_str(), 0600), 0);
    EXPECT_THROW(EventLog(file.path, fail), InputError);
    int const reader = ::open(file.path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    EXPECT_THROW(EventLog(file.path, fail), InputError);
    ::close(reader);
}

TEST(EventLog, OfAFullDiskItSpeaksOnce) {
    std::vector<std::string> said;
    {
        EventLog log("/dev/full", [&said](std::string const& problem) { said.push_back(problem); });
        log.begin({});
        log.add_viewer(1, coding::all);
        log.add_learning(1);
    }
    ASSERT_EQ(said.size(), 1u);
    EXPECT_NE(said[0].find("'/dev/full': No space left on device"), std::string::npos) << said[0];
}

TEST(EventLog, LeavesAFileAsItIsUntilItBegins) {
    TemporaryFile const file;
    std::ofstream(file.path) << "the recording before";
    { EventLog const log(file.path, fail); }
    EXPECT_EQ(std::filesystem::file_size(file.path), 20u);
}

} // namespace
} // namespace framelet
