// Fills pixels that are holes from cells of 2x2 pixels with a border of one.
uniform sampler2D depths;
uniform sampler2D level1;
uniform float uncovered; // colour of a pixel of which nothing is known
out vec4 color;
vec4 at(int x, int y) {
    return texelFetch(level1, ivec2(x, y) + 1, 0);
}
void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    if (texelFetch(depths, pixel, 0).x > hole_depth) {
        discard;
    }
    ivec2 own = parent_of(pixel);
    ivec2 other = other_of(pixel);
    vec4 cell = farthest_of(vec4(9.0, 3.0, 3.0, 1.0), at(own.x, own.y), at(other.x, own.y), at(own.x, other.y),
                            at(other.x, other.y));
    vec3 bytes = floor(min(sqrt(max(cell.rgb, vec3(0.0))) + 0.5, vec3(255.0)));
    color = vec4(is_nothing(cell) ? vec3(uncovered) : bytes / 255.0, 1.0);
}
