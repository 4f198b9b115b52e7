// The method `tsar`: temporally and spatially adaptive rendering as [Stephens 2011] describes it; both halves.
#pragma once

#include "tests/evaluation/methods/tsar_server.h"
#include "tests/evaluation/methods/tsar_viewer.h"

namespace framelet::bench {

class Tsar final : public Method {
public:
    explicit Tsar(MethodSetup const& setup, TsarParameters const& parameters = {});

    ServerStep produce(StepInput const& input) override { return server_.produce(input); }
    ViewerStep consume(std::vector<std::byte> const& message) override;
    Picture const& picture() const override { return viewer_.picture(); }
    double mean_sample_time() const override { return viewer_.mean_scene_time(); }
    Window window() const override { return {16}; }

private:
    CostTable const costs_;
    TsarServer server_;
    BatchCodec codec_;
    TsarViewer viewer_;
};

} // namespace framelet::bench
