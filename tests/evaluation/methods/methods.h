// Makes the methods, one a file.
#pragma once

#include "tests/evaluation/method.h"

namespace framelet::bench {

std::unique_ptr<Method> make_framed(MethodSetup const& setup);
std::unique_ptr<Method> make_framed_h264(MethodSetup const& setup);
std::unique_ptr<Method> make_framed_warp(MethodSetup const& setup);
std::unique_ptr<Method> make_interruptible(MethodSetup const& setup);
std::unique_ptr<Method> make_frameless(MethodSetup const& setup);
std::unique_ptr<Method> make_afr(MethodSetup const& setup);
std::unique_ptr<Method> make_framelet(MethodSetup const& setup);
std::unique_ptr<Method> make_framelet_unwarped(MethodSetup const& setup);
std::unique_ptr<Method> make_tsar(MethodSetup const& setup);

} // namespace framelet::bench
