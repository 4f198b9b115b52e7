// Hears what Assimp says in its log while it reads: there alone it tells what it leaves out. Out: lines of ours.
#pragma once

#include <mutex>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace framelet {

/// Listens from its construction to its end; Assimp has one log for the whole process, so that others wait meanwhile.
class AssimpLog {
public:
    AssimpLog();
    ~AssimpLog();
    AssimpLog(AssimpLog const&) = delete;
    AssimpLog& operator=(AssimpLog const&) = delete;

    /// What has been left out so far, each once.
    std::vector<std::string> losses() const;

private:
    class Stream;

    std::unique_lock<std::mutex> lock_;
    std::set<std::string> losses_;
};

/// What a line of Assimp's log says is missing from the picture, as "NURBS curves are not shown"; empty where it says
/// nothing of that kind.
std::string loss_in(std::string_view line);

} // namespace framelet
