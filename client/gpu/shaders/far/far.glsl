// Cells from which holes are filled, as `far_grid.h` has them: squares of bytes, and 1 / metres of the farthest.
const float nothing = 1e30;
const float hole_depth = -1.0;

bool is_nothing(vec4 cell) {
    return cell.w >= nothing;
}

// The weighted mean of those of four that are about as far as the farthest.
vec4 farthest_of(vec4 weights, vec4 a, vec4 b, vec4 c, vec4 d) {
    float farthest = min(min(a.w, b.w), min(c.w, d.w));
    float limit = farthest * 1.15 + 1e-4;
    vec4 take = weights * vec4(lessThanEqual(vec4(a.w, b.w, c.w, d.w), vec4(limit)));
    float scale = 1.0 / (((take.x + take.y) + take.z) + take.w);
    return vec4(scale * ((take.x * a.rgb + take.y * b.rgb) + (take.z * c.rgb + take.w * d.rgb)), farthest);
}

// The weighted mean of those of four cells that are not nothing.
vec4 known_of(vec4 weights, vec4 a, vec4 b, vec4 c, vec4 d) {
    vec4 take = weights * vec4(lessThan(vec4(a.w, b.w, c.w, d.w), vec4(nothing)));
    float total = ((take.x + take.y) + take.z) + take.w;
    vec4 sum = (take.x > 0.0 ? take.x * a : vec4(0.0)) + (take.y > 0.0 ? take.y * b : vec4(0.0)) +
               (take.z > 0.0 ? take.z * c : vec4(0.0)) + (take.w > 0.0 ? take.w * d : vec4(0.0));
    return total > 0.0 ? sum / total : vec4(0.0, 0.0, 0.0, nothing);
}

// The coarse cell that a fine one lies in, also of those before the first, and the nearest other one.
ivec2 parent_of(ivec2 fine) {
    return fine >> 1;
}
ivec2 other_of(ivec2 fine) {
    return (fine >> 1) + 2 * (fine & 1) - 1;
}
