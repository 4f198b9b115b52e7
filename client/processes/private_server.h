// A server for one user: framelet-server on a free port of this machine. In: the files of a scene. Out: where it
// listens, which it says by a descriptor of its own, where no name of a file can stand; or the line that says why it
// does not. What else it prints goes to this program's standard error.
#pragma once

#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "client/processes/child.h"

namespace framelet {

/// Progress of loading, as framelet-server tells it.
struct LoadProgress {
    std::string stage;
    int percent = 0; ///< of the stage
    bool operator==(LoadProgress const&) const = default;
};

class PrivateServer {
public:
    /// Starts loading. `options` are for framelet-server. `on_news` is called from another thread when it listens,
    /// when loading has got on, and when it prints no more. Throws InputError where the program is missing,
    /// std::system_error.
    PrivateServer(std::vector<std::string> const& scenes, std::vector<std::string> const& options,
                  std::function<void()> on_news);
    /// Ends the server, and waits until it has ended.
    ~PrivateServer();
    PrivateServer(PrivateServer const&) = delete;
    PrivateServer& operator=(PrivateServer const&) = delete;

    Child& process() { return *process_; }
    /// The progress of loading; nothing before the server tells it.
    std::optional<LoadProgress> progress() const;
    /// The server's address, HOST:PORT, once it listens.
    std::optional<std::string> address() const;
    /// The reason why a server that has ended did so, one line, which nobody has printed.
    std::string end_reason();

private:
    void read_to_the_end();
    void read(int news, int words);
    void take_news(std::string const& line);
    void take(std::string const& line);

    std::function<void()> const on_news_;

    mutable std::mutex mutex_; // guards what follows
    std::optional<std::string> address_;
    std::string complaint_;
    std::optional<LoadProgress> progress_;

    std::optional<Child> process_;
    std::thread reader_;
};

} // namespace framelet
