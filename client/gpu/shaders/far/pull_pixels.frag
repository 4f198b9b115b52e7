// Makes cells of 2x2 pixels, each the mean of what is farthest in them.
uniform sampler2D colors;
uniform sampler2D depths;
uniform ivec2 viewport;
out vec4 cell;
vec4 pixel_at(ivec2 pixel) {
    float depth = all(lessThan(pixel, viewport)) ? texelFetch(depths, pixel, 0).x : hole_depth;
    vec3 bytes = depth > hole_depth ? floor(texelFetch(colors, pixel, 0).rgb * 255.0 + 0.5) : vec3(0.0);
    return vec4(bytes * bytes, depth > hole_depth ? depth : nothing);
}
void main() {
    ivec2 first = 2 * ivec2(gl_FragCoord.xy);
    cell = farthest_of(vec4(1.0), pixel_at(first), pixel_at(first + ivec2(1, 0)), pixel_at(first + ivec2(0, 1)),
                       pixel_at(first + ivec2(1, 1)));
}
