// framelet-scenes: writes the bundled scenes as .glb files.
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <string>

#include <CLI/CLI.hpp>

#include "common/error.h"
#include "framelet_version.h"
#include "scenes/gltf/gltf_writer.h"
#include "scenes/scene_table.h"

namespace {

using namespace framelet;

void write_file(std::filesystem::path const& file, std::string const& bytes) {
    std::ofstream out(file, std::ios::binary);
    out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    out.close();
    if (!out) {
        throw InputError("cannot write '" + file.string() + "': is the folder there and writable?");
    }
}

void write_scene(SceneEntry const& entry, std::filesystem::path const& folder) {
    GltfDocument document = entry.make();
    document.name = entry.name;
    std::string const bytes = write_glb(document);
    write_file(folder / (entry.name + ".glb"), bytes);
    std::printf("%-17s %4.1f s %8zu triangles %9zu bytes\n", entry.name.c_str(), entry.duration,
                drawn_triangles(document), bytes.size());
}

} // namespace

int main(int argument_count, char** arguments) {
    CLI::App app("Writes the bundled scenes, one glTF 2.0 file (.glb) each. The same program writes the same bytes.");
    app.set_version_flag("--version", FRAMELET_VERSION);
    std::string folder;
    std::string only;
    bool committed = false;
    app.add_option("OUTDIR", folder, "Folder to write to; made where it is missing")->required();
    app.add_option(
        "--only", only,
        "Write this scene alone; terrain_large (20 million triangles) and forest (100 million, in instances) are "
        "written only so");
    app.add_flag("--committed", committed, "Only the scenes whose files the repository carries");
    try {
        app.parse(argument_count, arguments);
    } catch (CLI::ParseError const& error) {
        return app.exit(error) == 0 ? 0 : 2;
    }
    try {
        std::filesystem::create_directories(folder);
        bool found = false;
        for (SceneEntry const& entry : scene_table()) {
            if (only.empty() ? entry.committed || !committed : entry.name == only) {
                write_scene(entry, folder);
                found = true;
            }
        }
        for (SceneEntry const& entry : large_scene_table()) {
            if (entry.name == only) {
                write_scene(entry, folder);
                found = true;
            }
        }
        if (!found) {
            throw InputError("there is no scene '" + only + "': run without --only to see the names");
        }
    } catch (std::exception const& error) {
        std::fprintf(stderr, "framelet-scenes: %s\n", error.what());
        return 1;
    }
    return 0;
}
