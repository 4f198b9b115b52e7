#include "client/window/overlay.h"

#include <algorithm>
#include <cstdio>

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

namespace framelet {

namespace {

constexpr ImGuiWindowFlags plain = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize |
                                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoInputs |
                                   ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav;

/// A panel whose own point `anchor` (0..1) lies at that point of the window, a margin away from the edges, and
/// from so much of the lower one.
bool begin_panel(char const* name, ImVec2 anchor, float opacity = 0.75f, float above = 0) {
    ImVec2 const size = ImGui::GetIO().DisplaySize;
    float const margin = ImGui::GetFontSize();
    ImVec2 const place(margin + anchor.x * (size.x - 2 * margin), margin + anchor.y * (size.y - above - 2 * margin));
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

void text_panel(char const* name, ImVec2 anchor, std::string const& text, float above = 0) {
    if (begin_panel(name, anchor, 0.9f, above)) {
        ImGui::PushTextWrapPos(ImGui::GetIO().DisplaySize.x * 0.8f);
        ImGui::TextUnformatted(text.c_str());
        ImGui::PopTextWrapPos();
    }
    ImGui::End();
}

/// Also of what cannot be used now: that is when one asks why.
void tooltip(std::string const& text) {
    if (ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) {
        ImGui::PushStyleVar(ImGuiStyleVar_Alpha, 1); // not as pale as what cannot be used
        ImGui::SetTooltip("%s", text.c_str());
        ImGui::PopStyleVar();
    }
}

void button(char const* label, Command command, std::string const& tip, OverlayActions& actions) {
    if (ImGui::Button(label)) {
        actions.commands.push_back(command);
    }
    tooltip(tip);
    ImGui::SameLine();
}

void label(char const* text) {
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(text);
    ImGui::SameLine();
}

template <class... Values>
std::string formatted(char const* format, Values... values) {
    char text[64];
    std::snprintf(text, sizeof text, format, values...);
    return text;
}

void clock_controls(TimeLine const& line, float right_width, OverlayActions& actions) {
    // What cannot be used says why instead of what it does.
    auto const tip = [&](char const* text) { return line.fixed_because.empty() ? text : line.fixed_because; };
    ImGui::BeginDisabled(!line.fixed_because.empty());
    button("|<", Command::seek_start, tip("to the start (Home)"), actions);
    button("<", Command::step_back, tip("back by 1/30 s (,)"), actions);
    button(line.clock.playing ? "pause###play" : "play ###play", Command::play_or_pause, tip("play or pause (Space)"),
           actions);
    button(">", Command::step_forward, tip("on by 1/30 s (.)"), actions);
    double place = line.place();
    double const least = 0;
    std::string const format = formatted("%%.2f of %.2f s", line.duration);
    ImGui::SetNextItemWidth(std::max(ImGui::GetContentRegionAvail().x - right_width, 6 * ImGui::GetFontSize()));
    if (ImGui::SliderScalar("##time", ImGuiDataType_Double, &place, &least, &line.duration, format.c_str(),
                            ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_NoInput)) {
        actions.seek = line.time_at(place);
    }
    tooltip(tip("time of the animation: drag, or Left and Right for a second"));
    ImGui::SameLine();
    button("-##speed", Command::slower, tip("half the speed (-)"), actions);
    label(formatted("%gx", static_cast<double>(line.clock.speed)).c_str());
    button("+##speed", Command::faster, tip("twice the speed (+)"), actions);
    ImGui::EndDisabled();
}

/// Returns its height.
float time_line_bar(TimeLine const& line, OverlayActions& actions) {
    ImVec2 const size = ImGui::GetIO().DisplaySize;
    ImGuiStyle const& style = ImGui::GetStyle();
    float const height = ImGui::GetFrameHeight() + 2 * style.WindowPadding.y;
    ImGui::SetNextWindowPos(ImVec2(0, size.y - height));
    ImGui::SetNextWindowSize(ImVec2(size.x, height));
    ImGui::SetNextWindowBgAlpha(0.75f);
    ImGui::Begin("time line", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoNav |
                     ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoFocusOnAppearing |
                     ImGuiWindowFlags_NoScrollWithMouse);
    if (line.duration > 0) {
        float const button_width = ImGui::CalcTextSize("+").x + 2 * style.FramePadding.x;
        float const right_width =
            ImGui::CalcTextSize("0.0625x-16.00 EV").x + 4 * button_width + 7 * style.ItemSpacing.x;
        clock_controls(line, right_width, actions);
    }
    button("-##exposure", Command::darker, "darker by a quarter of a stop ([)", actions);
    label(formatted("%+.2f EV", static_cast<double>(line.exposure_ev)).c_str());
    button("+##exposure", Command::brighter, "brighter by a quarter of a stop (])", actions);
    ImGui::End();
    return height;
}

} // namespace

void Overlay::lay_out(OverlayContent const& content, OverlayActions& actions) {
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
    ImGuiIO const& io = ImGui::GetIO();
    float const bar_height = content.time_line ? time_line_bar(*content.time_line, actions) : 0;
    mouse_area_ = {0, static_cast<int>((io.DisplaySize.y - bar_height) * io.DisplayFramebufferScale.y),
                   static_cast<int>(io.DisplaySize.x * io.DisplayFramebufferScale.x),
                   static_cast<int>(io.DisplaySize.y * io.DisplayFramebufferScale.y)};
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
        text_panel("note", {0.5f, 1}, content.note, bar_height);
    }
    if (!content.message.empty()) {
        text_panel("message", {0.5f, 0.5f}, content.message);
    }
}

Overlay::Overlay(GLFWwindow* window, float scale) {
    IMGUI_CHECKVERSION();
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.ConfigFlags |= ImGuiConfigFlags_NoMouseCursorChange;
    ImFontConfig font;
    font.SizePixels = 13 * scale;
    io.Fonts->AddFontDefault(&font);
    ImGui::StyleColorsDark();
    ImGui::GetStyle().ScaleAllSizes(scale);
    ImGui::GetStyle().WindowRounding = 4 * scale;
    ImGui::GetStyle().WindowBorderSize = 0;
    ImGui_ImplGlfw_InitForOpenGL(window, true); // the window goes on hearing of everything
    ImGui_ImplOpenGL3_Init("#version 330 core");
}

Overlay::~Overlay() {
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
}

OverlayActions Overlay::draw(OverlayContent const& content) {
    OverlayActions actions;
    mouse_area_ = {};
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

} // namespace framelet
