// Finds whether most of a splat is hidden in a block: whether the pixel nearest to its middle is covered firmly, by
// what is near enough and no part of what it adds up with, when its turn comes. Whether most of a splat of an
// earlier patch was hidden is what the pass before has found, the first of which took all of them to show: to know it
// they would have to wait for each other.
uniform usampler2D blocks;
uniform usampler2D earlier; // what the pass before has found
uniform int is_first;
uniform int count; // of splats
out uint hidden;

bool is_left_out(int splat) {
    return is_first == 0 && texelFetch(earlier, ivec2(splat & 1023, splat >> 10), 0).x != 0u;
}

void main() {
    int splat = (int(gl_FragCoord.y) << 10) + int(gl_FragCoord.x);
    if (splat >= count) {
        discard;
    }
    vec4 at = uintBitsToFloat(texel_of(splats, 2 * splat));
    uvec4 origin = texel_of(splats, 2 * splat + 1); // colour, block, number of its patch there
    uvec4 block = texel_of(blocks, 2 * int(origin.y));
    int first_splat = int(texel_of(blocks, 2 * int(origin.y) + 1).x);
    ivec2 corner = 16 * ivec2(block.x & 0xffffu, block.x >> 16);
    ivec2 pixel = corner + ivec2(clamp(at.xy - vec2(corner), vec2(0.0), vec2(15.0)));
    paint(block, first_splat, int(origin.z), pixel);
    int own_group = int(texel_of(entries, int(block.y + origin.z)).z);
    bool is_loose = is_drifting(group) && !is_drifting(own_group) && depth > (1.0 + same_surface) * at.z;
    hidden = firm && group != own_group && depth >= (1.0 - same_surface) * at.z && !is_loose ? 1u : 0u;
}
