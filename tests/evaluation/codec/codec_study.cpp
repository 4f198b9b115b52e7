#include "tests/evaluation/codec/codec_study.h"

#include <cmath>
#include <cstdio>
#include <functional>

#include <nlohmann/json.hpp>
#include <tbb/global_control.h>

#include "common/error.h"
#include "common/framelet_cache.h"
#include "common/reconstruction.h"
#include "protocol/batch_codec.h"
#include "tests/evaluation/charts/charts.h"
#include "tests/evaluation/codecs/jpeg_codec.h"
#include "tests/evaluation/stopwatch.h"

namespace framelet::bench {
namespace {

using nlohmann::json;

/// A batch through a codec and back.
struct Coded {
    Batch decoded;
    std::size_t bytes = 0; ///< of colour
    std::size_t shape_bytes = 0;
    double encode_seconds = 0, decode_seconds = 0;
};

/// What both sides of the predicting codec hold.
struct Held {
    HeldPicture sent, received;
};

struct Candidate {
    std::string name;
    std::vector<int> qualities;
    std::function<Coded(Batch const&, int quality)> code;
    Held* held = nullptr; ///< where what batches before it left counts
};

/// `held`: null where each batch is coded alone.
Coded code_planes(BatchCodec& codec, Held* held, Batch batch, int quality) {
    if (quality != exact_quality) {
        batch.quality.assign(batch.framelets.size(), static_cast<std::uint8_t>(quality));
    }
    Coded coded;
    EncodedBatch encoded;
    coded.encode_seconds =
        processor_seconds_of([&] { encoded = codec.encode(batch, held == nullptr ? nullptr : &held->sent); });
    coded.decode_seconds = processor_seconds_of(
        [&] { coded.decoded = codec.decode(encoded, held == nullptr ? nullptr : &held->received); });
    coded.bytes = encoded.payload.size();
    coded.shape_bytes = encoded.shapes.size();
    return coded;
}

/// One picture of 16 pixels' width, the framelets below each other.
Coded code_strip(JpegCodec& codec, Batch const& batch, int quality) {
    Picture strip(framelet_side, framelet_side * static_cast<int>(batch.framelets.size()));
    std::size_t pixel = 0;
    auto const for_each_pixel = [&pixel](auto& framelets, auto const& body) {
        pixel = 0;
        for (auto& framelet : framelets) {
            for (std::uint32_t i = 0; i < framelet_samples; ++i, pixel += 4) {
                body(framelet, morton_index(i % framelet_side, i / framelet_side));
            }
        }
    };
    for_each_pixel(batch.framelets, [&](DisplayFramelet const& framelet, std::uint32_t k) {
        strip.rgba[pixel] = framelet.red[k];
        strip.rgba[pixel + 1] = framelet.green[k];
        strip.rgba[pixel + 2] = framelet.blue[k];
    });
    Coded coded{batch};
    Picture decoded;
    std::span<std::byte const> bytes;
    coded.encode_seconds = processor_seconds_of([&] { bytes = codec.encode(strip, quality); });
    coded.decode_seconds = processor_seconds_of([&] { codec.decode(bytes, decoded); });
    coded.bytes = bytes.size();
    for_each_pixel(coded.decoded.framelets, [&](DisplayFramelet& framelet, std::uint32_t k) {
        framelet.red[k] = decoded.rgba[pixel];
        framelet.green[k] = decoded.rgba[pixel + 1];
        framelet.blue[k] = decoded.rgba[pixel + 2];
    });
    return coded;
}

double square(std::uint8_t a, std::uint8_t b) {
    return (double(a) - double(b)) * (double(a) - double(b));
}

struct Error {
    double squares = 0, count = 0;

    void add(std::uint8_t a, std::uint8_t b) {
        squares += square(a, b);
        ++count;
    }
    /// Decibels; 99 where there is none.
    double psnr() const { return squares > 0 ? 10 * std::log10(255 * 255 * count / squares) : 99; }
};

void compare(std::vector<DisplayFramelet> const& a, std::vector<DisplayFramelet> const& b, Error& error) {
    for (std::size_t i = 0; i < a.size(); ++i) {
        for (std::size_t k = 0; k < framelet_samples; ++k) {
            error.add(a[i].red[k], b[i].red[k]);
            error.add(a[i].green[k], b[i].green[k]);
            error.add(a[i].blue[k], b[i].blue[k]);
        }
    }
}

/// What a viewer shows that had everything before, and all of these batches.
Picture picture_of(CorpusMoment const& moment, std::vector<Batch> const& batches, Viewport viewport) {
    FrameletCache cache{ImagePlane(viewport)};
    for (Batch const& batch : moment.lead) {
        cache.insert(batch);
    }
    for (Batch const& batch : batches) {
        cache.insert(batch);
    }
    Picture picture(viewport.width, viewport.height);
    reconstruct_all(cache, picture);
    return picture;
}

/// A moment's batches one after the other, as a session codes them, so many times: of each the shortest times.
std::vector<Coded> code(CorpusMoment const& moment, Candidate const& candidate, int quality, int rounds) {
    Held after_lead;
    if (candidate.held != nullptr) {
        *candidate.held = {};
        for (Batch const& batch : moment.lead) {
            candidate.code(batch, quality);
        }
        after_lead = *candidate.held;
    }
    std::vector<Coded> best;
    for (int round = 0; round < rounds; ++round) {
        if (candidate.held != nullptr) {
            *candidate.held = after_lead;
        }
        for (std::size_t i = 0; i < moment.batches.size(); ++i) {
            Coded coded = candidate.code(moment.batches[i], quality);
            if (round == 0) {
                best.push_back(std::move(coded));
            } else {
                best[i].encode_seconds = std::min(best[i].encode_seconds, coded.encode_seconds);
                best[i].decode_seconds = std::min(best[i].decode_seconds, coded.decode_seconds);
            }
        }
        FRAMELET_CHECK(candidate.held == nullptr || candidate.held->sent == candidate.held->received);
    }
    return best;
}

json measure(std::vector<CorpusMoment> const& corpus, Candidate const& candidate, int quality,
             CodecStudy const& study) {
    Error samples, pictures;
    double count = 0, bytes = 0, shape_bytes = 0, encode = 0, decode = 0;
    for (CorpusMoment const& moment : corpus) {
        std::vector<Coded> coded = code(moment, candidate, quality, study.rounds);
        std::vector<Batch> decoded;
        for (std::size_t i = 0; i < coded.size(); ++i) {
            Batch const& batch = moment.batches[i];
            compare(batch.framelets, coded[i].decoded.framelets, samples);
            count += static_cast<double>(batch.framelets.size() * framelet_samples);
            bytes += static_cast<double>(coded[i].bytes);
            shape_bytes += static_cast<double>(coded[i].shape_bytes);
            encode += coded[i].encode_seconds;
            decode += coded[i].decode_seconds;
            decoded.push_back(std::move(coded[i].decoded));
        }
        Picture const exact = picture_of(moment, moment.batches, study.corpus.viewport);
        Picture const shown = picture_of(moment, decoded, study.corpus.viewport);
        for (std::size_t i = 0; i < exact.rgba.size(); ++i) {
            if (i % 4 != 3) {
                pictures.add(exact.rgba[i], shown.rgba[i]);
            }
        }
    }
    return {{"codec", candidate.name},
            {"quality", quality},
            {"bytes_per_sample", bytes / count},
            {"shape_bytes_per_sample", shape_bytes / count},
            {"sample_psnr", samples.psnr()},
            {"picture_psnr", pictures.psnr()},
            {"encode_samples_per_second", count / encode},
            {"decode_samples_per_second", count / decode}};
}

void draw_chart(std::string const& scene, json const& rows, char const* error, std::string const& error_title,
                std::filesystem::path const& stem) {
    Curves chart;
    chart.title = scene + ": what the scheduler sends while everything moves";
    chart.x_title = "bytes a sample";
    chart.y_title = error_title;
    chart.log_x = true;
    for (json const& row : rows) {
        auto const name = row["codec"].get<std::string>();
        if (row["quality"] == exact_quality) {
            continue;
        }
        if (chart.curves.empty() || chart.curves.back().name != name) {
            chart.curves.push_back({name, {}, {}});
        }
        chart.curves.back().x.push_back(row["bytes_per_sample"]);
        chart.curves.back().y.push_back(row[error]);
    }
    draw(chart, stem);
}

} // namespace

json compare_codecs(CodecStudy const& study) {
    BatchCodec planes;
    JpegCodec jpeg;
    std::vector<int> const steps{4, 6, 8, 10, 12, 14, 18, 24, 32, 48};
    Held held;
    std::vector<Candidate> const candidates{
        {"planes", {exact_quality}, [&](auto const&... told) { return code_planes(planes, nullptr, told...); }},
        {"predicted", steps, [&](auto const&... told) { return code_planes(planes, &held, told...); }, &held},
        {"haar", steps, [&](auto const&... told) { return code_planes(planes, nullptr, told...); }},
        {"jpeg", {95, 93, 90, 85, 80, 70, 60, 50, 40}, [&](auto const&... told) { return code_strip(jpeg, told...); }},
    };
    json result = json::array();
    for (std::filesystem::path const& file : study.scenes) {
        auto const scene = load_bench_scene(file);
        auto const corpus = make_corpus(*scene, study.corpus);
        tbb::global_control const one_thread(tbb::global_control::max_allowed_parallelism, 1);
        std::printf(
            "%s\n  codec       quality  B/sample + shapes  PSNR samples, picture [dB]  encode, decode [Msamples/s]\n",
            scene->name.c_str());
        json rows = json::array();
        for (Candidate const& candidate : candidates) {
            if (!study.codecs.empty() && std::ranges::find(study.codecs, candidate.name) == study.codecs.end()) {
                continue;
            }
            for (int const quality : candidate.qualities) {
                json const& row = rows.emplace_back(measure(corpus, candidate, quality, study));
                std::printf("  %-12s %6d %9.4f + %.4f %13.2f %12.2f %14.0f %8.0f\n", candidate.name.c_str(), quality,
                            row["bytes_per_sample"].get<double>(), row["shape_bytes_per_sample"].get<double>(),
                            row["sample_psnr"].get<double>(), row["picture_psnr"].get<double>(),
                            row["encode_samples_per_second"].get<double>() / 1e6,
                            row["decode_samples_per_second"].get<double>() / 1e6);
            }
        }
        if (!study.charts.empty()) {
            std::filesystem::create_directories(study.charts);
            draw_chart(scene->name, rows, "sample_psnr", "PSNR of samples [dB]",
                       study.charts / ("codec_" + scene->name + "_samples"));
            draw_chart(scene->name, rows, "picture_psnr", "PSNR of the picture [dB]",
                       study.charts / ("codec_" + scene->name + "_picture"));
        }
        result.push_back({{"scene", scene->name}, {"rows", std::move(rows)}});
    }
    return result;
}

} // namespace framelet::bench
