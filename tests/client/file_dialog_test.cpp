#include "client/window/file_dialog.h"

#include <cstdlib>
#include <fstream>
#include <thread>

#include <gtest/gtest.h>

#include "common/error.h"
#include "tests/client/own_folder.h"

namespace framelet {
namespace {

/// A script in place of a program of the desktop, which is alone in PATH.
class FileDialogTest : public testing::Test {
protected:
    void install(std::string const& name, std::string const& script) {
        std::filesystem::path const file = folder_.path() / name;
        std::ofstream(file) << "#!/bin/sh\n" << script << '\n';
        std::filesystem::permissions(file, std::filesystem::perms::owner_all);
    }
    void SetUp() override { ASSERT_EQ(::setenv("PATH", folder_.path().c_str(), 1), 0); } // each case is a process

    /// What the user has chosen once the dialog is closed.
    std::vector<std::string> answer(FileDialog& dialog) {
        answers_.get_future().wait();
        std::vector<std::string> files;
        for (int i = 0; i < 1000 && files.empty(); ++i) { // it is told of a moment before it is there
            files = dialog.poll();
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        return files;
    }

    OwnFolder const folder_;
    std::promise<void> answers_;
    FileDialog dialog_{[this] { answers_.set_value(); }};
};

TEST_F(FileDialogTest, GivesTheFilesThatWereChosenOnce) {
    install("zenity", "echo '/a b/one.glb'; echo /two.obj");
    dialog_.open();
    EXPECT_EQ(answer(dialog_), (std::vector<std::string>{"/a b/one.glb", "/two.obj"}));
    EXPECT_TRUE(dialog_.poll().empty());
}

TEST_F(FileDialogTest, OneThatIsClosedGivesNone) {
    install("kdialog", "exit 1");
    dialog_.open();
    EXPECT_TRUE(answer(dialog_).empty());
}

TEST_F(FileDialogTest, WithoutAProgramForItThatIsSaid) {
    EXPECT_THROW(dialog_.open(), InputError);
    EXPECT_TRUE(dialog_.poll().empty());
}

TEST_F(FileDialogTest, EndsWithWhoeverAsked) {
    install("zenity", "exec /bin/sleep 1000");
    dialog_.open();
    dialog_.open(); // it is there already
    EXPECT_TRUE(dialog_.poll().empty());
}

} // namespace
} // namespace framelet
