// Paints a pixel of a block.
uniform usampler2D hidden; // by splat: 1 where nothing of it is to show
flat in uvec4 block;
flat in int first_splat;
layout(location = 0) out vec4 out_color; // bytes as sRGB has them; alpha 0: may be filtered
layout(location = 1) out float out_depth; // 1 / metres; -1 in holes
layout(location = 2) out uvec4 out_claims; // a bit for each of the first 127 patches, one for all others
// The first patch of the group that shows; from bit 8 on its slot; bit 16: no hole; bit 17: a patch shows.
layout(location = 3) out uint out_winner;

const uint in_place_flag = 1u;
const int still_bit = 1 << 29;

bool is_left_out(int splat) {
    return texelFetch(hidden, ivec2(splat & 1023, splat >> 10), 0).x != 0u;
}

void main() {
    out_claims = paint(block, first_splat, int(block.z & 0xffffu), ivec2(gl_FragCoord.xy));
    bool is_in_place = (block.z >> 16 & in_place_flag) != 0u;
    bool shows = weight > 0.0;
    vec3 bytes = floor(sqrt(shows ? color / weight : vec3(0.0)) + 0.5);
    out_color = vec4(bytes / 255.0, (group & still_bit) != 0 ? 1.0 : 0.0); // the group of a hole has all bits set
    out_depth = shows ? depth : (is_in_place ? 0.0 : hole_depth);
    out_winner = shows ? leader | (uint(group) >> 24 & 31u) << 8 | 3u << 16 : (is_in_place ? 1u << 16 : 0u);
}
