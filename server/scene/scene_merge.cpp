#include "server/scene/scene_merge.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <utility>

#include "common/error.h"

namespace framelet {
namespace {

/// Puts the word of its scene before each name that another scene has as well.
template <typename Thing>
void tell_apart(std::vector<Scene>& scenes, std::vector<Thing> Scene::*things, std::span<std::string const> words) {
    std::map<std::string, std::set<std::size_t>> owners;
    for (std::size_t s = 0; s < scenes.size(); ++s) {
        for (Thing const& thing : scenes[s].*things) {
            owners[thing.name].insert(s);
        }
    }
    for (std::size_t s = 0; s < scenes.size(); ++s) {
        for (Thing& thing : scenes[s].*things) {
            if (!thing.name.empty() && owners[thing.name].size() > 1) {
                thing.name = words[s] + "/" + thing.name;
            }
        }
    }
}

void move_by(Index& index, std::size_t offset) {
    index += index == none ? 0 : static_cast<Index>(offset);
}

/// Makes the indices of a scene those that its parts will have behind what `before` has.
void move_indices(Scene& scene, Scene const& before) {
    for (Texture& texture : scene.textures) {
        move_by(texture.image, before.images.size());
    }
    for (Material& material : scene.materials) {
        for (TextureUse* const use : texture_uses(material)) {
            move_by(use->texture, before.textures.size());
        }
    }
    for (Mesh& mesh : scene.meshes) {
        for (Primitive& primitive : mesh.primitives) {
            move_by(primitive.material, before.materials.size());
        }
    }
    for (Node& node : scene.nodes) {
        move_by(node.parent, before.nodes.size());
        move_by(node.mesh, before.meshes.size());
        move_by(node.skin, before.skins.size());
    }
    for (Skin& skin : scene.skins) {
        for (Index& joint : skin.joints) {
            move_by(joint, before.nodes.size());
        }
    }
    for (AnimationClip& clip : scene.clips) {
        for (AnimationChannel& channel : clip.channels) {
            move_by(channel.node, before.nodes.size());
        }
    }
    for (Light& light : scene.lights) {
        move_by(light.node, before.nodes.size());
    }
    for (SceneCamera& camera : scene.cameras) {
        move_by(camera.node, before.nodes.size());
    }
}

template <typename Thing>
void append(std::vector<Thing>& to, std::vector<Thing>&& from) {
    to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
}

/// "a + b + c", and of many scenes the first two.
std::string joined_name(std::span<std::string const> words) {
    constexpr std::size_t most = 3;
    std::size_t const shown = words.size() > most ? most - 1 : words.size();
    std::string name;
    for (std::size_t i = 0; i < shown; ++i) {
        name += (i > 0 ? " + " : "") + words[i];
    }
    return shown < words.size() ? name + " + " + std::to_string(words.size() - shown) + " more" : name;
}

} // namespace

Scene merged_scene(std::vector<Scene> scenes, std::span<std::string const> words) {
    FRAMELET_CHECK(scenes.size() == words.size());
    tell_apart(scenes, &Scene::materials, words);
    tell_apart(scenes, &Scene::meshes, words);
    tell_apart(scenes, &Scene::nodes, words);
    tell_apart(scenes, &Scene::clips, words);
    tell_apart(scenes, &Scene::lights, words);
    tell_apart(scenes, &Scene::cameras, words);
    Scene out;
    out.name = joined_name(words);
    out.scene_files = 0;
    bool const agree = std::ranges::all_of(scenes, [&](Scene const& scene) { return scene.light == scenes[0].light; });
    out.light = agree && !scenes.empty() ? scenes[0].light : "";
    std::vector<std::filesystem::path> other_files;
    for (std::size_t s = 0; s < scenes.size(); ++s) {
        Scene& scene = scenes[s];
        move_indices(scene, out);
        append(out.images, std::move(scene.images));
        append(out.textures, std::move(scene.textures));
        append(out.materials, std::move(scene.materials));
        append(out.meshes, std::move(scene.meshes));
        append(out.nodes, std::move(scene.nodes));
        append(out.skins, std::move(scene.skins));
        append(out.clips, std::move(scene.clips));
        append(out.lights, std::move(scene.lights));
        append(out.cameras, std::move(scene.cameras));
        for (std::string const& warning : scene.warnings) {
            out.warnings.push_back(words[s] + ": " + warning);
        }
        auto const others =
            scene.files.begin() + static_cast<std::ptrdiff_t>(std::min(scene.scene_files, scene.files.size()));
        out.files.insert(out.files.end(), scene.files.begin(), others);
        out.scene_files += scene.scene_files;
        other_files.insert(other_files.end(), others, scene.files.end());
    }
    append(out.files, std::move(other_files));
    return out;
}

std::vector<std::string> words_for(std::span<std::filesystem::path const> files) {
    std::vector<std::string> words;
    for (std::filesystem::path const& file : files) {
        std::string const stem = file.stem().string();
        std::string word = stem;
        for (int number = 2; std::ranges::find(words, word) != words.end(); ++number) {
            word = stem + "-" + std::to_string(number);
        }
        words.push_back(std::move(word));
    }
    return words;
}

} // namespace framelet
