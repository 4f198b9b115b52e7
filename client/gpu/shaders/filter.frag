// Filters outlines as `filter_pixels` does.
uniform sampler2D colors;
uniform ivec2 viewport;
uniform float contrast; // difference of bytes up to which nothing is filtered
out vec4 color;
vec4 at(ivec2 pixel) {
    return floor(texelFetch(colors, clamp(pixel, ivec2(0), viewport - 1), 0) * 255.0 + 0.5);
}
void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 middle = at(pixel);
    color = vec4(middle.rgb / 255.0, 1.0);
    if (middle.a > 0.0) {
        return;
    }
    vec3 left = at(pixel - ivec2(1, 0)).rgb;
    vec3 right = at(pixel + ivec2(1, 0)).rgb;
    vec3 above = at(pixel - ivec2(0, 1)).rgb;
    vec3 below = at(pixel + ivec2(0, 1)).rgb;
    if (all(lessThanEqual(abs(vec4(left.g, right.g, above.g, below.g) - middle.g), vec4(contrast)))) {
        return;
    }
    vec3 sum = 4.0 * middle.rgb * middle.rgb + left * left + right * right + above * above + below * below;
    color.rgb = floor(sqrt(sum * 0.125) + 0.5) / 255.0;
}
