#include "server/scene/summary/scene_identity.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <functional>
#include <string_view>
#include <type_traits>

#include <unistd.h>

#include "common/mix_bits.h"

namespace framelet {
namespace {

class Digest {
public:
    void add(std::string_view bytes) { value_ = mix_in(value_, std::hash<std::string_view>{}(bytes) ^ bytes.size()); }
    template <typename Value>
    void add(std::vector<Value> const& values) {
        static_assert(std::is_trivially_copyable_v<Value>);
        add(std::string_view(reinterpret_cast<char const*>(values.data()), values.size() * sizeof(Value)));
    }
    template <typename... Numbers>
    void add_numbers(Numbers... numbers) {
        add(std::vector<float>{static_cast<float>(numbers)...});
    }
    void add(Vec3 const& v) { add_numbers(v.x, v.y, v.z); }
    void add(glm::dvec3 const& v) { add(std::vector<double>{v.x, v.y, v.z}); }

    std::uint64_t value() const { return value_; }

private:
    std::uint64_t value_ = 1;
};

void add(Digest& digest, Primitive const& primitive) {
    digest.add(primitive.positions);
    digest.add(primitive.triangles);
    digest.add(primitive.uv[0]);
    digest.add(primitive.colors);
    digest.add_numbers(primitive.material);
}

void add(Digest& digest, Material const& material) {
    Vec4 const& color = material.base_color;
    digest.add_numbers(color.x, color.y, color.z, color.w, material.metallic, material.roughness,
                       material.base_color_texture.texture);
    digest.add(material.emissive);
}

void add(Digest& digest, Node const& node) {
    Quat const& rotation = node.local.rotation;
    digest.add(node.name);
    digest.add(node.local.translation);
    digest.add_numbers(rotation.x, rotation.y, rotation.z, rotation.w, node.parent, node.mesh);
    digest.add(node.local.scale);
    if (node.matrix) {
        digest.add(std::vector<glm::dmat4>{*node.matrix});
    }
}

} // namespace

std::uint64_t scene_identity(Scene const& scene) {
    Digest digest;
    digest.add(scene.name);
    digest.add(scene.origin);
    for (auto const& image : scene.images) {
        if (image) {
            digest.add(image->rgba);
        }
    }
    for (Mesh const& mesh : scene.meshes) {
        for (Primitive const& primitive : mesh.primitives) {
            add(digest, primitive);
        }
    }
    for (Material const& material : scene.materials) {
        add(digest, material);
    }
    for (Node const& node : scene.nodes) {
        add(digest, node);
    }
    for (AnimationClip const& clip : scene.clips) {
        digest.add(clip.name);
        for (AnimationChannel const& channel : clip.channels) {
            digest.add(channel.times);
            digest.add(channel.values);
        }
    }
    return std::max<std::uint64_t>(digest.value(), 1);
}

std::uint64_t scene_source(Scene const& scene) {
    if (scene.files.empty()) {
        return 0;
    }
    std::uint64_t out = 1; // no std::hash, which is another one in another build
    auto const add = [&out](std::string_view text) {
        for (char const c : text) {
            out = mix_in(out, static_cast<unsigned char>(c));
        }
        out = mix_in(out, text.size());
    };
    std::array<char, 256> machine{};
    ::gethostname(machine.data(), machine.size() - 1);
    add(machine.data());
    for (std::size_t i = 0; i < std::min(scene.scene_files, scene.files.size()); ++i) {
        std::error_code error; // where it is set, the name counts as it was asked for
        std::filesystem::path const file = std::filesystem::weakly_canonical(scene.files[i], error);
        add(error ? scene.files[i].native() : file.native());
    }
    return std::max<std::uint64_t>(out, 1);
}

} // namespace framelet
