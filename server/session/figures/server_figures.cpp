#include "server/session/figures/server_figures.h"

#include <fstream>
#include <sstream>

#include <unistd.h>

namespace framelet {

std::string metrics_text(ServerFigures const& f) {
    std::ostringstream out;
    out.precision(15);
    auto const add = [&out](char const* name, char const* type, char const* help, auto value) {
        out << "# HELP " << name << ' ' << help << "\n# TYPE " << name << ' ' << type << '\n'
            << name << ' ' << value << '\n';
    };
    add("framelet_healthy", "gauge", "1 where the server does what it is there for.", f.healthy ? 1 : 0);
    add("framelet_ready", "gauge", "1 where another viewer is welcome: it is healthy, not full, and does not end.",
        f.ready ? 1 : 0);
    add("framelet_busy", "gauge", "Share of the last second that there was something to do for viewers.", f.busy);
    add("framelet_sessions", "gauge", "Viewers that are here.", f.sessions);
    add("framelet_viewers_total", "counter", "Viewers that were let in, again each time they came back.", f.viewers);
    add("framelet_scene_loads_total", "counter", "Scenes that were served, one after the other.", f.scenes);
    add("framelet_sent_bytes_total", "counter", "Bytes sent to viewers, before encryption.", f.sent_bytes);
    add("framelet_workers", "gauge", "Processes that trace paths of light for this one.", f.workers);
    add("framelet_worker_paths_total", "counter", "Paths of light that these have traced.", f.worker_paths);
    add("framelet_rays_total", "counter", "Rays from cameras that were rendered for viewers.", f.rays);
    add("framelet_rays_per_second", "gauge", "Rays a second that all of the time would be enough for.",
        f.rays_per_second);
    add("framelet_busy_seconds_total", "counter", "Seconds that there was something to do for viewers.",
        f.busy_seconds);
    if (f.resident_bytes > 0) {
        add("process_resident_memory_bytes", "gauge", "Resident memory of the process.", f.resident_bytes);
    }
    return out.str();
}

std::uint64_t resident_bytes() {
    std::uint64_t mapped = 0, resident = 0;
    std::ifstream("/proc/self/statm") >> mapped >> resident;
    return resident * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

} // namespace framelet
