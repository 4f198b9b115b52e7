// A process that is a worker of another server for as long as it runs. In: where that server is, the same scene. Out:
// the paths that it orders.
#pragma once

#include "protocol/connection/server_address.h"
#include "server/session/loaded_scene.h"

namespace framelet {

/// Works until SIGINT or SIGTERM, and looks for the server again where it is gone. The scene's light has to be by
/// paths. Throws ConnectionError where the server wants none of it: wrong token, another scene, other light.
void work_for(ConnectionOptions const& server, LoadedScene& scene, std::size_t threads);

} // namespace framelet
