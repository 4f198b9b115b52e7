// Does what `paint_warped_block` does, for one pixel: paints the patches of its block one after the other, the best
// first. The reasons that are given there are not repeated here.
uniform usampler2DArray samples;
uniform usampler2D patches;
uniform usampler2D entries;
uniform usampler2D lists;
uniform usampler2D splats;

const float firm_tent = 0.25;
const float faint = 1e-3;
const float same_surface = 0.01;
const float rounding = 1e-5;
const float hole_depth = -1.0;
const float faded_share = 0.1;
const int texels_of_patch = 6;
const int drifting_bit = 1 << 30; // of groups
const uint hides_flag = 1u, ends_flag = 2u; // of patches
const uint outlier_flag = 1u << 16; // of entries

// The surface in front at the pixel so far.
vec3 color = vec3(0.0);
float weight = 0.0;
float depth = hole_depth;
int group = -1;
bool firm = false;
float ended = -1e30;
uint leader = 255u;

struct Candidate {
    vec3 color;
    float weight;
    float depth;
    bool firm;
    bool ends;
};

vec3 squares_of(uint sample_bytes) {
    vec3 bytes = vec3(sample_bytes & 255u, (sample_bytes >> 8) & 255u, (sample_bytes >> 16) & 255u);
    return bytes * bytes;
}

bool is_drifting(int any_group) {
    return any_group >= 0 && (any_group & drifting_bit) != 0;
}

// A shadow lies on no surface there, and hides nothing.
bool shows_loose_shadow(float own_depth, float limit, int own_group) {
    return !is_drifting(own_group) && is_drifting(group) && depth - own_depth > limit;
}

bool is_hidden(float own_depth, float tolerance, int own_group) {
    return firm && group != own_group && depth >= (1.0 + rounding - same_surface) * own_depth - tolerance &&
           !shows_loose_shadow(own_depth, tolerance + same_surface * own_depth, own_group);
}

// Lets a candidate compete with what is in front. True where it shows.
bool merge(Candidate own, int own_group, float tolerance, uint own_leader) {
    float limit = tolerance + same_surface * own.depth;
    bool shows = own.weight > faint;
    bool is_firm = shows && own.firm && !(abs(own.depth - ended) <= limit);
    if (own.ends && ended < 0.0) {
        ended = own.depth;
    }
    bool joins = shows && group == own_group && abs(own.depth - depth) <= limit;
    bool in_front = own.depth > depth + limit || shows_loose_shadow(own.depth, limit, own_group);
    bool wins = shows && ((is_firm && !firm) || (is_firm == firm && in_front));
    if (joins) {
        color += own.color;
        weight += own.weight;
        firm = firm || is_firm;
    } else if (wins) {
        color = own.color;
        weight = own.weight;
        depth = own.depth;
        group = own_group;
        firm = is_firm;
        leader = own_leader;
    }
    return joins || wins;
}

// True where bit `number` is set of the eight words in two texels.
bool contains(int first, uint number) {
    uvec4 bits = texel_of(patches, first + int(number >> 7));
    return ((bits[(number >> 5) & 3u] >> (number & 31u)) & 1u) != 0u;
}

bool paint_layer(int patch_texel, int own_group, uint own_leader, vec2 from) {
    vec4 plane = uintBitsToFloat(texel_of(patches, patch_texel));
    float tolerance = plane.w;
    Candidate own;
    own.depth = max((plane.x + from.y * plane.z) + from.x * plane.y, 0.0);
    if (is_hidden(own.depth, tolerance, own_group)) {
        return false;
    }
    vec4 a = uintBitsToFloat(texel_of(patches, patch_texel + 1));
    vec4 b = uintBitsToFloat(texel_of(patches, patch_texel + 2));
    uvec4 grid = texel_of(patches, patch_texel + 3);
    vec3 position = (a.xyz + from.y * vec3(b.zw, uintBitsToFloat(grid.x))) + from.x * vec3(a.w, b.xy);
    if (!(position.z > 0.0)) {
        return false;
    }
    vec2 uv = position.xy / position.z;
    int side = int(grid.z & 255u);
    uint number = (grid.z >> 8) & 255u;
    uint flags = grid.z >> 16;
    vec2 cell = floor(min(max(uv, vec2(0.0)), vec2(side - 2)));
    vec2 beyond = uv - cell;
    vec2 after = max(min(beyond, 2.0 - beyond), vec2(0.0)); // weights of the samples to the right and below
    vec2 before = max(min(1.0 - beyond, 1.0 + beyond), vec2(0.0));
    if (!(max(after.x, before.x) > 0.0 && max(after.y, before.y) > 0.0)) {
        return false;
    }
    ivec3 at = ivec3(int(grid.y & 1023u) + int(cell.x), int((grid.y >> 10) & 1023u) + int(cell.y), int(grid.y >> 20));
    uint s00 = texelFetch(samples, at, 0).x;
    uint s10 = texelFetch(samples, at + ivec3(1, 0, 0), 0).x;
    uint s01 = texelFetch(samples, at + ivec3(0, 1, 0), 0).x;
    uint s11 = texelFetch(samples, at + ivec3(1, 1, 0), 0).x;
    vec4 shares = vec4(before.x * before.y, after.x * before.y, before.x * after.y, after.x * after.y);
    shares *= vec4((s00 >> 24) == number, (s10 >> 24) == number, (s01 >> 24) == number, (s11 >> 24) == number);
    own.weight = (shares.x + shares.y) + (shares.z + shares.w);
    own.color = (shares.x * squares_of(s00) + shares.y * squares_of(s10)) +
                (shares.z * squares_of(s01) + shares.w * squares_of(s11));
    bool right = after.x >= 0.5;
    bool below = after.y >= 0.5;
    bool in_cell = (right || before.x >= 0.5) && (below || before.y >= 0.5);
    uint nearest = (below ? (right ? s11 : s01) : (right ? s10 : s00)) >> 24;
    own.firm = in_cell && nearest == number;
    own.ends = (flags & ends_flag) != 0u && in_cell && contains(patch_texel + 4, nearest);
    if ((flags & hides_flag) == 0u) {
        own.firm = false;
        own.color *= faded_share;
        own.weight *= faded_share;
    }
    return merge(own, own_group, tolerance, own_leader);
}

// True where most of a splat is hidden, so that nothing of it is to show. Defined by the shader that includes this.
bool is_left_out(int splat);

bool paint_outliers(int list, int own_group, int first_splat, uint own_leader, ivec2 pixel) {
    int part = ((pixel.y & 15) >> 2) * 4 + ((pixel.x & 15) >> 2);
    int last = list + int(texel_of(lists, list + part + 1).x);
    bool shows = false;
    for (int i = list + int(texel_of(lists, list + part).x); i < last; ++i) {
        int splat = first_splat + int(texel_of(lists, i).x);
        vec4 at = uintBitsToFloat(texel_of(splats, 2 * splat));
        if (is_hidden(at.z, 0.0, own_group) || is_left_out(splat)) {
            continue;
        }
        vec2 tents = max(1.0 - abs(vec2(pixel) + 0.5 - at.xy) / at.w, vec2(0.0));
        Candidate own;
        own.weight = tents.x * tents.y;
        if (!(own.weight > faint)) {
            continue;
        }
        own.color = own.weight * squares_of(texel_of(splats, 2 * splat + 1).x);
        own.depth = at.z;
        own.firm = own.weight >= firm_tent;
        own.ends = false;
        shows = merge(own, own_group, 0.0, own_leader) || shows;
    }
    return shows;
}

// Paints the first `count` patches of a block (`PatchTable::blocks`) at a pixel. Returns a bit for each of the first
// 127 of which something showed, and one for all others.
uvec4 paint(uvec4 block, int first_splat, int count, ivec2 pixel) {
    int first = int(block.y);
    uvec2 own = uvec2(pixel) & 15u; // in the block
    uvec4 claims = uvec4(0u);
    for (int i = 0; i < count; ++i) {
        uvec4 entry = texel_of(entries, first + i);
        uvec4 box = uvec4(entry.y, entry.y >> 4, entry.y >> 8, entry.y >> 12) & 15u; // its last column and row included
        if (any(lessThan(own, box.xy)) || any(greaterThan(own, box.zw))) {
            continue;
        }
        int group_of_patch = int(entry.z);
        uint leader_of_patch = entry.x >> 24;
        bool shows = false;
        if ((entry.y & outlier_flag) != 0u) {
            shows = paint_outliers(int(block.w + entry.w), group_of_patch, first_splat, leader_of_patch, pixel);
        } else {
            ivec2 corner = ivec2(entry.w & 0xffffu, entry.w >> 16); // of the patch's box
            shows = paint_layer(texels_of_patch * int(entry.x & 0xffffffu), group_of_patch, leader_of_patch,
                                vec2(pixel - corner));
        }
        if (shows) {
            int bit = min(i, 127);
            claims[bit >> 5] |= 1u << (bit & 31);
        }
    }
    return claims;
}
