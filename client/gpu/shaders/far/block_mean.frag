// The mean of what is farthest in a block, as `far_mean`: of sixteen pixels where it has no holes.
uniform sampler2D colors;
uniform sampler2D depths;
uniform sampler2D level3;
uniform usampler2D figures;
uniform ivec2 viewport;
out vec4 mean;
vec4 pixel_at(ivec2 pixel) {
    float depth = all(lessThan(pixel, viewport)) ? texelFetch(depths, pixel, 0).x : hole_depth;
    vec3 bytes = depth > hole_depth ? floor(texelFetch(colors, pixel, 0).rgb * 255.0 + 0.5) : vec3(0.0);
    return vec4(bytes * bytes, depth > hole_depth ? depth : nothing);
}
vec4 four_at(ivec2 first) {
    return farthest_of(vec4(1.0), pixel_at(first), pixel_at(first + ivec2(4, 0)), pixel_at(first + ivec2(0, 4)),
                       pixel_at(first + ivec2(4, 4)));
}
void main() {
    ivec2 block = ivec2(gl_FragCoord.xy);
    if (texelFetch(figures, block, 0).z == 0u) {
        ivec2 first = 16 * block + 1;
        mean = farthest_of(vec4(1.0), four_at(first), four_at(first + ivec2(8, 0)), four_at(first + ivec2(0, 8)),
                           four_at(first + ivec2(8, 8)));
    } else {
        ivec2 first = 2 * block;
        mean = farthest_of(vec4(1.0), texelFetch(level3, first, 0), texelFetch(level3, first + ivec2(1, 0), 0),
                           texelFetch(level3, first + ivec2(0, 1), 0), texelFetch(level3, first + ivec2(1, 1), 0));
    }
}
