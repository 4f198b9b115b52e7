// Scenes made to defeat an adaptive renderer, each in one way. One file a scene: scene_<name>.cpp.
#pragma once

#include <vector>

#include "scenes/gltf/gltf_document.h"

namespace framelet {

/// Thin lattice sails, and a wheel of thin vanes, turn quickly before windows and pales.
struct WindmillParameters {
    double duration = 4; ///< seconds
    int sail_turns = 5, vane_turns = 9; ///< within `duration`
    int sails = 4, vanes = 16;
};
GltfDocument make_windmill_scene(WindmillParameters const& parameters);

/// A detailed sphere turns about its tilted axis while it goes round an ellipse on the floor.
struct GlobeParameters {
    double duration = 6; ///< seconds
    int turns = 3; ///< within `duration`
    double radius = 1.1; ///< metres
    D2 travel{1.9, 1.2}; ///< half axes of the ellipse, metres
};
GltfDocument make_globe_scene(GlobeParameters const& parameters);

/// A million triangles whose shading changes from one to the next; the camera flies round above them.
struct TerrainParameters {
    double duration = 16; ///< seconds
    int columns = 710, rows = 710; ///< two triangles a cell
    double cell = 0.28; ///< metres
    double flight_radius = 62, flight_height = 50; ///< metres
};
GltfDocument make_terrain_scene(TerrainParameters const& parameters);

/// Everything moves, the camera too, then nothing does.
struct StopParameters {
    double duration = 6, moving = 3; ///< seconds; the rest is still
};
GltfDocument make_stop_scene(StopParameters const& parameters);

/// A garage by the light of a lamp with a bad contact. glTF cannot animate a light's strength: the lamp's node jumps
/// to the other side of the ceiling and back.
struct FlickerParameters {
    double duration = 4; ///< seconds
    std::vector<bool> lit; ///< equal intervals
    double lamp_candela = 34, other_candela = 2.5;
};
GltfDocument make_flicker_scene(FlickerParameters const& parameters);

/// Nothing moves, but the camera is at another place every so often.
struct TeleportParameters {
    double duration = 6; ///< seconds
    struct View {
        D3 eye, target; ///< world, metres
    };
    std::vector<View> views; ///< equal intervals
};
GltfDocument make_teleport_scene(TeleportParameters const& parameters);

/// Trees of alpha-masked twigs, most of them smaller than a pixel; they sway, the camera drifts.
struct FoliageParameters {
    double duration = 8; ///< seconds
    int trees = 44, twigs = 520; ///< twigs a crown
    double sway_degrees = 1.6;
    double drift = 1.2; ///< of the camera: metres to either side
};
GltfDocument make_foliage_scene(FoliageParameters const& parameters);

/// The same things turn on both sides of a screen; on the right everything is black as soot.
struct DimParameters {
    double duration = 4; ///< seconds
    int turns = 3; ///< within `duration`
    double soot = 0.07; ///< colours there, relative to the left side
};
GltfDocument make_dim_scene(DimParameters const& parameters);

/// A figure walks round a column, another runs round both: skins, seen from all sides, over slabs and before bricks.
struct WalkerParameters {
    double duration = 4; ///< seconds, of a whole round
    double walk_radius = 1.05, run_radius = 2.2; ///< of the rounds, metres
    int walk_cycles = 5, run_cycles = 6; ///< pairs of steps in a round
};
GltfDocument make_walker_scene(WalkerParameters const& parameters);

/// A printed flag and a pennant wave by morph targets, two for each wave that travels along them.
struct FlagParameters {
    double duration = 4; ///< seconds
    int long_waves = 4, short_waves = 7; ///< that pass a place within `duration`
};
GltfDocument make_flag_scene(FlagParameters const& parameters);

/// A fan turns below the lamps of a furnished room: the shadows of its blades sweep over all of it.
struct FanParameters {
    double duration = 4; ///< seconds
    int turns = 4, blades = 5; ///< turns within `duration`
    double drift = 0.12; ///< of the camera: metres to either side
};
GltfDocument make_fan_scene(FanParameters const& parameters);

/// Things turn behind two panes of glass; beside them lacquer and brass stand against the sun, on which highlights
/// wander as the camera goes sideways.
struct GlassParameters {
    double duration = 4; ///< seconds
    int turns = 3; ///< within `duration`
    double drift = 0.9; ///< of the camera: metres to either side
};
GltfDocument make_glass_scene(GlassParameters const& parameters);

} // namespace framelet
