#include "server/scene/reading/image_loading.h"

#include <mutex>

#include <tbb/parallel_for.h>

#include "common/error.h"
#include "common/files/image_io.h"
#include "common/files/picture_header.h"
#include "server/scene/reading/file_bytes.h"

namespace framelet {
namespace {

/// New index of each of the kept elements; `none` for the others.
std::vector<Index> new_indices(std::size_t count, auto const& keep) {
    std::vector<Index> result(count, none);
    Index next = 0;
    for (std::size_t i = 0; i < count; ++i) {
        if (keep(i)) {
            result[i] = next++;
        }
    }
    return result;
}

/// Memory that is taken until the end of the scope.
class Reserved {
public:
    Reserved(ImportBudget& budget, std::uint64_t bytes) : budget_(budget), bytes_(bytes) { budget.reserve(bytes, 1); }
    ~Reserved() { budget_.give_back(bytes_); }
    Reserved(Reserved const&) = delete;
    Reserved& operator=(Reserved const&) = delete;

private:
    ImportBudget& budget_;
    std::uint64_t const bytes_;
};

std::vector<std::byte> read_image(std::filesystem::path const& file, SceneFolder const& folder, ImportBudget& budget) {
    std::optional<RegularFile> const opened = folder.open(file);
    if (!opened) {
        throw InputError("cannot read image '" + file.string() + "': the file cannot be read");
    }
    return read_file(*opened, file.string(), budget);
}

} // namespace

std::vector<std::shared_ptr<Picture const>> load_images(std::span<EncodedImage const> images, SceneFolder const& folder,
                                                        ImportBudget& budget, std::vector<std::string>& warnings,
                                                        Progress const& progress) {
    std::vector<std::shared_ptr<Picture const>> pictures(images.size());
    std::vector<std::string> problems(images.size());
    SizeCheck const reserve = [&](int width, int height) {
        budget.reserve(static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height), 4);
    };
    if (!images.empty()) {
        progress("images", 0);
    }
    auto const read = [&](std::size_t i) {
        EncodedImage const& image = images[i];
        if (image.decoded) {
            pictures[i] = image.decoded;
            return;
        }
        try {
            if (image.bytes.empty() && image.file.empty()) {
                throw InputError(image.problem.empty() ? "image '" + image.name + "' is missing" : image.problem);
            }
            std::vector<std::byte> const in_file =
                image.bytes.empty() ? read_image(image.file, folder, budget) : std::vector<std::byte>();
            auto const bytes = image.bytes.empty() ? std::span(in_file) : image.bytes; // else they have been counted
            Reserved const beside(budget, bytes_beside(bytes));
            pictures[i] = std::make_shared<Picture const>(
                read_picture(bytes, image.bytes.empty() ? image.file.string() : image.name, reserve));
        } catch (SceneTooLarge const&) {
            throw;
        } catch (InputError const& error) {
            problems[i] = std::string(error.what()) + "; shown without it";
        }
    };
    std::mutex report;
    std::size_t done = 0;
    tbb::parallel_for(std::size_t(0), images.size(), [&](std::size_t i) {
        read(i);
        std::lock_guard const lock(report);
        ++done;
        progress("images", static_cast<double>(done) / static_cast<double>(images.size()));
    });
    for (std::string& problem : problems) {
        if (!problem.empty()) {
            warnings.push_back(std::move(problem));
        }
    }
    return pictures;
}

void drop_missing_images(Scene& scene) {
    auto const new_image = new_indices(scene.images.size(), [&](std::size_t i) { return scene.images[i] != nullptr; });
    std::erase(scene.images, nullptr);
    for (Texture& texture : scene.textures) {
        texture.image = texture.image == none ? none : new_image[static_cast<std::size_t>(texture.image)];
    }
    auto const new_texture =
        new_indices(scene.textures.size(), [&](std::size_t i) { return scene.textures[i].image != none; });
    std::erase_if(scene.textures, [](Texture const& texture) { return texture.image == none; });
    for (Material& material : scene.materials) {
        for (TextureUse* const use : texture_uses(material)) {
            use->texture = use->texture == none ? none : new_texture[static_cast<std::size_t>(use->texture)];
        }
    }
}

} // namespace framelet
