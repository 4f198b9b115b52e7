#include "server/scene/gltf/gltf_document.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "common/error.h"

namespace framelet {
namespace {

/// JSON nested deeper than this is refused: nobody writes it.
constexpr std::size_t max_depth = 64;

/// Bytes that are reserved for what there is in JSON: what it takes itself, and what may be made of it before anybody
/// looks again, which is a material or a node of "{}", in a list that grows, and a matrix of a joint.
constexpr std::uint64_t object_bytes = sizeof(Json::object_t) + 2 * std::max(sizeof(Material), sizeof(Node));
constexpr std::uint64_t member_bytes = sizeof(Json::object_t::value_type) + 4 * sizeof(void*);
constexpr std::uint64_t value_bytes = 3 * sizeof(Json) + sizeof(Mat4);

/// Makes a document of what the parser finds. (Its own parser with a filter takes time squared for long lists.)
class DocumentBuilder final : public nlohmann::json_sax<Json> {
public:
    explicit DocumentBuilder(ImportBudget& budget) : budget_(budget) {}

    Json take() { return std::move(root_); }

    bool null() override { return add(nullptr); }
    bool boolean(bool value) override { return add(value); }
    bool number_integer(number_integer_t value) override { return add(value); }
    bool number_unsigned(number_unsigned_t value) override { return add(value); }
    bool number_float(number_float_t value, string_t const&) override { return add(value); }
    bool string(string_t& value) override {
        budget_.reserve(value.size(), 1);
        return add(std::move(value));
    }
    bool binary(binary_t&) override { return true; } // there is none in text
    bool start_object(std::size_t) override { return start(Json::object(), object_bytes); }
    bool end_object() override { return end(); }
    bool start_array(std::size_t) override { return start(Json::array(), 0); }
    bool end_array() override { return end(); }
    bool key(string_t& value) override {
        if (skipped_ == 0) {
            budget_.reserve(member_bytes + value.size(), 1);
            bool const is_of_asset = open_.size() == 2 && open_.back() == asset_;
            skips_next_ = value == "extras" && !is_of_asset;
            key_ = std::move(value);
        }
        return true;
    }
    bool parse_error(std::size_t, std::string const&, nlohmann::detail::exception const& error) override {
        std::string const why = error.what();
        std::size_t const kind_end = why.find("] ");
        throw InputError("its JSON is broken: " + why.substr(kind_end == std::string::npos ? 0 : kind_end + 2));
    }

private:
    /// The value in its place, or null where it is passed over.
    Json* place(Json value) {
        if (skipped_ > 0 || std::exchange(skips_next_, false)) {
            return nullptr;
        }
        if (open_.empty()) {
            return &(root_ = std::move(value));
        }
        Json& in = *open_.back();
        if (in.is_array()) {
            in.push_back(std::move(value));
            return &in.back();
        }
        return &(in[key_] = std::move(value));
    }
    bool add(Json value) {
        if (place(std::move(value))) {
            budget_.reserve(value_bytes, 1);
        }
        return true;
    }
    bool start(Json empty, std::uint64_t bytes) {
        if (++depth_ > max_depth) {
            throw InputError("its JSON is nested too deeply");
        }
        if (Json* const placed = place(std::move(empty))) {
            budget_.reserve(sizeof(Json) + bytes, 1);
            if (open_.size() == 1 && key_ == "asset") {
                asset_ = placed;
            }
            open_.push_back(placed);
        } else if (skipped_ == 0) {
            skipped_ = depth_;
        }
        return true;
    }
    bool end() {
        if (skipped_ == 0) {
            open_.pop_back();
        } else if (skipped_ == depth_) {
            skipped_ = 0;
        }
        --depth_;
        return true;
    }

    ImportBudget& budget_;
    Json root_;
    std::vector<Json*> open_; ///< the innermost last
    Json const* asset_ = nullptr; ///< whose extras are kept
    std::string key_;
    bool skips_next_ = false; ///< what comes next is passed over
    std::size_t skipped_ = 0; ///< depth of what is being passed over; 0: nothing is
    std::size_t depth_ = 0;
};

} // namespace

Json parse_gltf_json(std::string_view text, ImportBudget& budget) {
    DocumentBuilder builder(budget);
    Json::sax_parse(text, &builder);
    Json json = builder.take();
    std::string const version = framelet::text(member(json, "asset"), "version");
    if (!version.starts_with("2.")) {
        throw InputError(version.empty() ? "it is not glTF: \"asset\": {\"version\"} is missing"
                                         : "it is glTF version " + version + "; only 2.x is supported");
    }
    return json;
}

} // namespace framelet
