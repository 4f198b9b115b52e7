#include "tests/evaluation/codec/codec_study.h"

#include <cmath>
#include <cstdio>

#include <nlohmann/json.hpp>
#include <tbb/global_control.h>

#include "common/error.h"
#include "protocol/batch_codec.h"
#include "tests/evaluation/charts/charts.h"
#include "tests/evaluation/stopwatch.h"

namespace framelet::bench {
namespace {

using nlohmann::json;

constexpr int steps[] = {4, 6, 8, 10, 12, 14, 18, 24, 32, 48};

struct Way {
    char const* name;
    bool predicts;
    int quality;
};

/// One moment, coded and decoded.
struct Coded {
    std::vector<EncodedBatch> messages;
    std::vector<Batch> decoded;
    double encode_seconds = INFINITY, decode_seconds = INFINITY; ///< of the fastest round
};

/// A moment's batches one after the other, as a session codes them, then the same on the other side: these are two
/// machines', whose caches hold one side's picture each.
void code_once(CorpusMoment const& moment, Way const& way, Coded& coded) {
    BatchCodec codec;
    HeldPicture sent, received;
    HeldPicture* const held_here = way.predicts ? &sent : nullptr;
    HeldPicture* const held_there = way.predicts ? &received : nullptr;
    auto const with_quality = [&way](Batch batch) {
        if (way.quality != exact_quality) {
            batch.quality.assign(batch.framelets.size(), static_cast<std::uint8_t>(way.quality));
        }
        return batch;
    };
    for (Batch const& batch : moment.lead) {
        codec.decode(codec.encode(with_quality(batch), held_here), held_there);
    }
    coded.messages.clear();
    coded.decoded.clear();
    double encoding = 0, decoding = 0;
    for (Batch const& batch : moment.batches) {
        Batch const wanted = with_quality(batch);
        encoding += processor_seconds_of([&] { coded.messages.push_back(codec.encode(wanted, held_here)); });
    }
    for (EncodedBatch const& message : coded.messages) {
        decoding += processor_seconds_of([&] { coded.decoded.push_back(codec.decode(message, held_there)); });
    }
    FRAMELET_CHECK(sent == received);
    coded.encode_seconds = std::min(coded.encode_seconds, encoding);
    coded.decode_seconds = std::min(coded.decode_seconds, decoding);
}

/// Sum of squared differences of all bytes of colour.
double squares_between(std::vector<DisplayFramelet> const& a, std::vector<DisplayFramelet> const& b) {
    double sum = 0;
    auto const add = [&sum](std::uint8_t x, std::uint8_t y) {
        sum += (double(x) - double(y)) * (double(x) - double(y));
    };
    for (std::size_t i = 0; i < a.size(); ++i) {
        for (std::size_t k = 0; k < framelet_samples; ++k) {
            add(a[i].red[k], b[i].red[k]);
            add(a[i].green[k], b[i].green[k]);
            add(a[i].blue[k], b[i].blue[k]);
        }
    }
    return sum;
}

json measure(std::vector<CorpusMoment> const& corpus, Way const& way, int rounds) {
    double samples = 0, bytes = 0, shape_bytes = 0, squares = 0, encode = 0, decode = 0;
    for (CorpusMoment const& moment : corpus) {
        Coded coded;
        for (int round = 0; round < rounds; ++round) {
            code_once(moment, way, coded);
        }
        for (std::size_t i = 0; i < moment.batches.size(); ++i) {
            std::vector<DisplayFramelet> const& original = moment.batches[i].framelets;
            samples += static_cast<double>(original.size() * framelet_samples);
            bytes += static_cast<double>(coded.messages[i].payload.size());
            shape_bytes += static_cast<double>(coded.messages[i].shapes.size());
            squares += squares_between(original, coded.decoded[i].framelets);
        }
        encode += coded.encode_seconds;
        decode += coded.decode_seconds;
    }
    return {{"codec", way.name},
            {"quality", way.quality},
            {"bytes_per_sample", bytes / samples},
            {"shape_bytes_per_sample", shape_bytes / samples},
            {"psnr", squares > 0 ? 10 * std::log10(255 * 255 * 3 * samples / squares) : 99},
            {"encode_samples_per_second", samples / encode},
            {"decode_samples_per_second", samples / decode}};
}

void print(json const& row) {
    std::printf("  %-12s %6d %9.4f + %.4f %10.2f %12.0f %8.0f\n", row["codec"].get<std::string>().c_str(),
                row["quality"].get<int>(), row["bytes_per_sample"].get<double>(),
                row["shape_bytes_per_sample"].get<double>(), row["psnr"].get<double>(),
                row["encode_samples_per_second"].get<double>() / 1e6,
                row["decode_samples_per_second"].get<double>() / 1e6);
    std::fflush(stdout);
}

void draw_chart(std::string const& scene, json const& rows, std::filesystem::path const& folder) {
    Curves chart{.title = scene + ": what the scheduler sends while everything moves",
                 .x_title = "bytes a sample",
                 .y_title = "PSNR of samples [dB]",
                 .log_x = true,
                 .curves = {{"predicted", {}, {}}, {"haar", {}, {}}}};
    for (json const& row : rows) {
        for (Curve& curve : chart.curves) {
            if (row["codec"] == curve.name) {
                curve.x.push_back(row["bytes_per_sample"]);
                curve.y.push_back(row["psnr"]);
            }
        }
    }
    std::filesystem::create_directories(folder);
    draw(chart, folder / ("codec-" + scene));
}

} // namespace

json compare_codecs(CodecStudy const& study) {
    std::vector<Way> ways{{"planes", false, exact_quality}};
    for (bool const predicts : {true, false}) {
        for (int const step : steps) {
            ways.push_back({predicts ? "predicted" : "haar", predicts, step});
        }
    }
    json result = json::array();
    for (std::filesystem::path const& file : study.scenes) {
        auto const scene = load_bench_scene(file);
        auto const corpus = make_corpus(*scene, study.corpus);
        tbb::global_control const one_thread(tbb::global_control::max_allowed_parallelism, 1);
        std::printf("%s\n  codec       quality  B/sample + shapes  PSNR [dB]  encode, decode [Msamples/s]\n",
                    scene->name.c_str());
        json rows = json::array();
        for (Way const& way : ways) {
            print(rows.emplace_back(measure(corpus, way, study.rounds)));
        }
        if (!study.charts.empty()) {
            draw_chart(scene->name, rows, study.charts);
        }
        result.push_back({{"scene", scene->name}, {"rows", std::move(rows)}});
    }
    return result;
}

} // namespace framelet::bench
