#include "tests/evaluation/codec/codec_study.h"

#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>

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

/// What goes over the wire, of whichever codec.
struct Message {
    Batch const* original = nullptr; ///< not on the wire: what a picture's codec does not say of tiles
    EncodedBatch batch;
    std::vector<std::byte> picture;
    std::size_t bytes = 0; ///< of colour
    std::size_t shape_bytes = 0;
};

/// A batch through a codec and back.
struct Coded {
    Message message;
    Batch decoded;
    double encode_seconds = 0, decode_seconds = 0;
};

/// What both sides of the predicting codec hold.
struct Held {
    HeldPicture sent, received;
};

struct Candidate {
    std::string name;
    std::vector<int> qualities;
    std::function<void(Batch const&, int quality, Coded&)> encode;
    std::function<void(Coded&)> decode;
    Held* held = nullptr; ///< where what batches before it left counts
};

/// `held`: null where each batch is coded alone.
void encode_planes(BatchCodec& codec, Held* held, Batch batch, int quality, Coded& coded) {
    if (quality != exact_quality) {
        batch.quality.assign(batch.framelets.size(), static_cast<std::uint8_t>(quality));
    }
    Message& message = coded.message;
    coded.encode_seconds =
        processor_seconds_of([&] { message.batch = codec.encode(batch, held == nullptr ? nullptr : &held->sent); });
    message.bytes = message.batch.payload.size();
    message.shape_bytes = message.batch.shapes.size();
}

void decode_planes(BatchCodec& codec, Held* held, Coded& coded) {
    coded.decode_seconds = processor_seconds_of(
        [&] { codec.decode(coded.message.batch, held == nullptr ? nullptr : &held->received, coded.decoded); });
}

/// Calls `body(framelet, k, pixel)` for all samples, the framelets below each other in a picture.
template <typename Framelets, typename Body>
void for_each_pixel(Framelets& framelets, Body const& body) {
    std::size_t pixel = 0;
    for (auto& framelet : framelets) {
        for (std::uint32_t i = 0; i < framelet_samples; ++i, pixel += 4) {
            body(framelet, morton_index(i % framelet_side, i / framelet_side), pixel);
        }
    }
}

/// One picture of 16 pixels' width.
void encode_strip(JpegCodec& codec, Batch const& batch, int quality, Coded& coded) {
    Picture strip(framelet_side, framelet_side * static_cast<int>(batch.framelets.size()));
    for_each_pixel(batch.framelets, [&](DisplayFramelet const& framelet, std::uint32_t k, std::size_t pixel) {
        strip.rgba[pixel] = framelet.red[k];
        strip.rgba[pixel + 1] = framelet.green[k];
        strip.rgba[pixel + 2] = framelet.blue[k];
    });
    std::span<std::byte const> bytes;
    coded.encode_seconds = processor_seconds_of([&] { bytes = codec.encode(strip, quality); });
    coded.message.original = &batch;
    coded.message.picture.assign(bytes.begin(), bytes.end());
    coded.message.bytes = bytes.size();
}

void decode_strip(JpegCodec& codec, Coded& coded) {
    Picture decoded;
    coded.decode_seconds = processor_seconds_of([&] { codec.decode(coded.message.picture, decoded); });
    coded.decoded = *coded.message.original;
    for_each_pixel(coded.decoded.framelets, [&](DisplayFramelet& framelet, std::uint32_t k, std::size_t pixel) {
        framelet.red[k] = decoded.rgba[pixel];
        framelet.green[k] = decoded.rgba[pixel + 1];
        framelet.blue[k] = decoded.rgba[pixel + 2];
    });
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

/// A moment's batches one after the other, as a session codes them, so many times, then the same on the other side:
/// these are two machines', whose caches hold one side's picture each. Of each batch the shortest times.
std::vector<Coded> code(CorpusMoment const& moment, Candidate const& candidate, int quality, int rounds) {
    Held after_lead;
    if (candidate.held != nullptr) {
        *candidate.held = {};
        for (Batch const& batch : moment.lead) {
            Coded coded;
            candidate.encode(batch, quality, coded);
            candidate.decode(coded);
        }
        after_lead = *candidate.held;
    }
    std::vector<Coded> all(moment.batches.size());
    auto const repeat = [&](double Coded::*seconds, auto const& step) {
        std::vector<double> least(all.size(), std::numeric_limits<double>::max());
        for (int round = 0; round < rounds; ++round) {
            if (candidate.held != nullptr) {
                *candidate.held = after_lead;
            }
            for (std::size_t i = 0; i < all.size(); ++i) {
                step(i);
                least[i] = std::min(least[i], all[i].*seconds);
            }
        }
        for (std::size_t i = 0; i < all.size(); ++i) {
            all[i].*seconds = least[i];
        }
    };
    repeat(&Coded::encode_seconds, [&](std::size_t i) { candidate.encode(moment.batches[i], quality, all[i]); });
    HeldPicture const sent = candidate.held != nullptr ? candidate.held->sent : HeldPicture{};
    repeat(&Coded::decode_seconds, [&](std::size_t i) { candidate.decode(all[i]); });
    FRAMELET_CHECK(candidate.held == nullptr || sent == candidate.held->received);
    return all;
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
            bytes += static_cast<double>(coded[i].message.bytes);
            shape_bytes += static_cast<double>(coded[i].message.shape_bytes);
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
    auto const planes_of = [&](std::string name, std::vector<int> qualities, Held* of) {
        return Candidate{std::move(name), std::move(qualities),
                         [&planes, of](Batch const& batch, int quality, Coded& coded) {
                             encode_planes(planes, of, batch, quality, coded);
                         },
                         [&planes, of](Coded& coded) { decode_planes(planes, of, coded); }, of};
    };
    std::vector<Candidate> const candidates{
        planes_of("planes", {exact_quality}, nullptr),
        planes_of("predicted", steps, &held),
        planes_of("haar", steps, nullptr),
        {"jpeg",
         {95, 93, 90, 85, 80, 70, 60, 50, 40},
         [&](Batch const& batch, int quality, Coded& coded) { encode_strip(jpeg, batch, quality, coded); },
         [&](Coded& coded) { decode_strip(jpeg, coded); }},
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
