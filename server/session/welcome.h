// Makes what a viewer is told of the scene when it connects. In: the scene and the clips that play. Out: the message,
// but for what is the viewer's own: clock, ticket and control.
#pragma once

#include <span>

#include "protocol/messages/message.h"
#include "server/scene/scene.h"

namespace framelet {

Welcome make_welcome(Scene const& scene, std::span<Index const> clips);

} // namespace framelet
