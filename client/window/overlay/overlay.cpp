#include "client/window/overlay/overlay.h"

#include <utility>

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include "client/window/overlay/overlay_parts.h"

namespace framelet {

namespace {

PixelRect pixels(OverlayArea const& area, ImVec2 scale) {
    return {static_cast<int>(area.from.x * scale.x), static_cast<int>(area.from.y * scale.y),
            static_cast<int>(area.to.x * scale.x), static_cast<int>(area.to.y * scale.y)};
}

} // namespace

void Overlay::lay_out(OverlayContent const& content, OverlayActions& actions) {
    ImGuiConfigFlags& flags = ImGui::GetIO().ConfigFlags;
    flags = content.has_pointer ? flags & ~ImGuiConfigFlags_NoMouse : flags | ImGuiConfigFlags_NoMouse;
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
    ImGuiIO const& io = ImGui::GetIO();
    std::vector<OverlayArea> areas;
    ServerField const takes_keys = content.address ? content.address->takes_keys : ServerField::none;
    OverlayFrame frame{actions, areas, edit_, std::exchange(had_keys_, takes_keys), std::exchange(closes_menu_, false)};
    if (content.time_line) {
        draw_bar(content, frame);
    }
    covered_below_ = static_cast<int>(frame.bar_height * io.DisplayFramebufferScale.y);
    if (content.statistics && content.help.empty()) { // there is room for one of them in small windows
        draw_statistics(*content.statistics, frame);
    }
    if (content.legend) {
        draw_legend(*content.legend, frame);
    }
    if (!content.help.empty()) {
        draw_help(content.help, frame);
    }
    if (!content.sign.empty()) {
        draw_text("sign", {content.statistics ? 1.0f : 0.5f, 0}, content.sign, frame, content.progress);
    }
    if (!content.note.empty()) {
        draw_text("note", {0.5f, 1}, content.note, frame);
    }
    if (!content.message.empty()) {
        draw_message(content, server_, frame);
    }
    has_menu_ = ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup);
    if (has_menu_) { // a click beside it closes it, and does no more
        areas.push_back({ImVec2(0, 0), io.DisplaySize});
    }
    mouse_areas_.clear();
    for (OverlayArea const& area : areas) {
        mouse_areas_.push_back(pixels(area, io.DisplayFramebufferScale));
    }
}

Overlay::Overlay(GLFWwindow* window) {
    IMGUI_CHECKVERSION();
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.ConfigFlags |= ImGuiConfigFlags_NoMouseCursorChange;
    ImGui_ImplGlfw_InitForOpenGL(window, true); // the window goes on hearing of everything
    ImGui_ImplOpenGL3_Init("#version 330 core");
}

Overlay::~Overlay() {
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
}

void Overlay::set_scale(float scale) {
    scale_ = scale;
    ImFontConfig font;
    font.SizePixels = 13 * scale;
    ImFontAtlas& fonts = *ImGui::GetIO().Fonts;
    fonts.Clear();
    fonts.AddFontDefault(&font);
    ImGui_ImplOpenGL3_DestroyDeviceObjects(); // the next frame makes them anew, with these letters
    ImGuiStyle& style = ImGui::GetStyle();
    style = ImGuiStyle();
    ImGui::StyleColorsDark();
    style.ScaleAllSizes(scale);
    style.WindowRounding = 4 * scale;
    style.WindowBorderSize = 0;
}

OverlayActions Overlay::draw(OverlayContent const& content, float scale) {
    if (scale != scale_) {
        set_scale(scale);
    }
    if (content.address && content.address->proposed != proposed_) {
        proposed_ = content.address->proposed;
        server_ = {*proposed_};
    }
    OverlayActions actions;
    mouse_areas_.clear();
    if (content != drawn_ && !content.empty()) {
        // A panel that was not there before has no size yet, and its first frame does not show it.
        lay_out(content, actions);
        ImGui::EndFrame();
    }
    drawn_ = content;
    if (!content.empty()) {
        lay_out(content, actions);
        ImGui::Render();
        ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
    }
    return actions;
}

bool Overlay::is_typed_into() const {
    return ImGui::GetIO().WantTextInput;
}

} // namespace framelet
