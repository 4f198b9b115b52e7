#include "client/overlay.h"

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

namespace framelet {

namespace {

constexpr ImGuiWindowFlags plain = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize |
                                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoInputs |
                                   ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav;

/// A panel whose own point `anchor` (0..1) lies at that point of the window, a margin away from the edges.
bool begin_panel(char const* name, ImVec2 anchor, float opacity = 0.75f) {
    ImVec2 const size = ImGui::GetIO().DisplaySize;
    float const margin = ImGui::GetFontSize();
    ImVec2 const place(margin + anchor.x * (size.x - 2 * margin), margin + anchor.y * (size.y - 2 * margin));
    ImGui::SetNextWindowPos(place, ImGuiCond_Always, anchor);
    ImGui::SetNextWindowBgAlpha(opacity);
    return ImGui::Begin(name, nullptr, plain);
}

void table(char const* name, TextRows const& rows) {
    if (ImGui::BeginTable(name, 2, ImGuiTableFlags_SizingFixedFit)) {
        for (auto const& [left, right] : rows) {
            ImGui::TableNextRow();
            ImGui::TableNextColumn();
            ImGui::PushStyleColor(ImGuiCol_Text, ImVec4(0.7f, 0.8f, 1, 1));
            ImGui::TextUnformatted(left.c_str());
            ImGui::PopStyleColor();
            ImGui::TableNextColumn();
            ImGui::TextUnformatted(right.c_str());
        }
        ImGui::EndTable();
    }
}

void text_panel(char const* name, ImVec2 anchor, std::string const& text) {
    if (begin_panel(name, anchor, 0.9f)) {
        ImGui::PushTextWrapPos(ImGui::GetIO().DisplaySize.x * 0.8f);
        ImGui::TextUnformatted(text.c_str());
        ImGui::PopTextWrapPos();
    }
    ImGui::End();
}

void lay_out(OverlayContent const& content) {
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
    if (!content.statistics.empty()) {
        if (begin_panel("statistics", {0, 0})) {
            table("statistics table", content.statistics);
        }
        ImGui::End();
    }
    if (!content.help.empty()) {
        if (begin_panel("help", {1, 0})) {
            table("help table", content.help);
        }
        ImGui::End();
    }
    if (!content.sign.empty()) {
        text_panel("sign", {0.5f, 0}, content.sign);
    }
    if (!content.note.empty()) {
        text_panel("note", {0.5f, 1}, content.note);
    }
    if (!content.message.empty()) {
        text_panel("message", {0.5f, 0.5f}, content.message);
    }
}

} // namespace

Overlay::Overlay(GLFWwindow* window, float scale) {
    IMGUI_CHECKVERSION();
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.ConfigFlags |= ImGuiConfigFlags_NoMouse | ImGuiConfigFlags_NoMouseCursorChange;
    ImFontConfig font;
    font.SizePixels = 13 * scale;
    io.Fonts->AddFontDefault(&font);
    ImGui::StyleColorsDark();
    ImGui::GetStyle().ScaleAllSizes(scale);
    ImGui::GetStyle().WindowRounding = 4 * scale;
    ImGui::GetStyle().WindowBorderSize = 0;
    ImGui_ImplGlfw_InitForOpenGL(window, false);
    ImGui_ImplOpenGL3_Init("#version 330 core");
}

Overlay::~Overlay() {
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
}

void Overlay::draw(OverlayContent const& content) {
    if (content != drawn_ && !content.empty()) {
        // A panel that was not there before has no size yet, and its first frame does not show it.
        lay_out(content);
        ImGui::EndFrame();
    }
    drawn_ = content;
    if (!content.empty()) {
        lay_out(content);
        ImGui::Render();
        ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
    }
}

} // namespace framelet
