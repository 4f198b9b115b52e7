// Makes cells of twice the side, each the mean of what is farthest in four.
uniform sampler2D fine;
out vec4 cell;
void main() {
    ivec2 first = 2 * ivec2(gl_FragCoord.xy);
    cell = farthest_of(vec4(1.0), texelFetch(fine, first, 0), texelFetch(fine, first + ivec2(1, 0), 0),
                       texelFetch(fine, first + ivec2(0, 1), 0), texelFetch(fine, first + ivec2(1, 1), 0));
}
