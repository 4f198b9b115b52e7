#include "client/window/overlay/overlay_parts.h"

#include <algorithm>
#include <array>

#include "client/core/drawn_over/age_colors.h"
#include "client/viewer/commands.h"
#include "client/window/overlay/overlay_text.h"
#include "protocol/connection/server_address.h"

namespace framelet {

namespace {

ImVec4 const name_color(0.7f, 0.8f, 1, 1);

void cell(std::string const& text) {
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(text.c_str());
}

void name_cell(std::string const& text) {
    ImGui::TableNextColumn();
    ImGui::TextColored(name_color, "%s", text.c_str());
}

/// A figure's name and value; the tooltip of both says what it is.
void figure_cells(std::string const& name, std::string const& value) {
    name_cell(name);
    tooltip(figure_tip(name));
    cell(value);
    tooltip(figure_tip(name));
}

void table(char const* name, TextRows const& rows) {
    if (ImGui::BeginTable(name, 2, ImGuiTableFlags_SizingFixedFit)) {
        for (auto const& [left, right] : rows) {
            figure_cells(left, right);
        }
        ImGui::EndTable();
    }
}

void plot(Plot const& figure) {
    // Plots begin at zero, so that heights can be compared, and have some room above.
    float const highest = std::max(figure.whole, figure.values.empty() ? 0 : *std::ranges::max_element(figure.values));
    float const font = ImGui::GetFontSize();
    ImGui::TableNextColumn();
    ImGui::PlotLines(("##" + figure.name).c_str(), figure.values.data(), static_cast<int>(figure.values.size()), 0,
                     nullptr, 0, std::max(1.1f * highest, 1e-6f), ImVec2(9 * font, 1.3f * font));
}

/// Draws the colours of age, and what both their ends mean.
void draw_ramp(Legend const& legend) {
    float const font = ImGui::GetFontSize();
    ImVec2 const from = ImGui::GetCursorScreenPos();
    constexpr int steps = 48;
    float const step = 18 * font / steps;
    for (int i = 0; i < steps; ++i) {
        OverlayColor const color = age_color(static_cast<float>(i) / (steps - 1));
        std::array<int, 3> rgb{};
        std::ranges::transform(color, rgb.begin(), [](float value) { return static_cast<int>(value); });
        float const left = from.x + step * static_cast<float>(i);
        ImGui::GetWindowDrawList()->AddRectFilled(ImVec2(left, from.y), ImVec2(left + step, from.y + font),
                                                  IM_COL32(rgb[0], rgb[1], rgb[2], 255));
    }
    ImGui::Dummy(ImVec2(18 * font, font));
    ImGui::TextUnformatted(legend.newest.c_str());
    ImGui::SameLine(18 * font + ImGui::GetStyle().WindowPadding.x - ImGui::CalcTextSize(legend.oldest.c_str()).x);
    ImGui::TextUnformatted(legend.oldest.c_str());
}

/// Draws groups below each other. Widths of the names and of what they do, pixels.
void help_column(std::span<HelpGroup const> groups, float name_width, float text_width) {
    ImGui::BeginGroup();
    for (HelpGroup const& group : groups) {
        ImGui::TextDisabled("%s", group.title.c_str());
        if (ImGui::BeginTable(group.title.c_str(), 2, ImGuiTableFlags_SizingFixedFit)) {
            ImGui::TableSetupColumn("keys", ImGuiTableColumnFlags_WidthFixed, name_width);
            ImGui::TableSetupColumn("what they do", ImGuiTableColumnFlags_WidthFixed, text_width);
            for (auto const& [name, text] : group.rows) {
                name_cell(name);
                ImGui::TableNextColumn();
                ImGui::PushTextWrapPos(0);
                ImGui::TextUnformatted(text.c_str());
                ImGui::PopTextWrapPos();
            }
            ImGui::EndTable();
        }
    }
    ImGui::EndGroup();
}

/// The use of mouse and keyboard on a panel.
enum class PanelKind {
    told, ///< none
    takes_mouse,
    takes_keys, ///< Tab goes through its fields, too
    scrolls, ///< its wheel scrolls, where there is more of it than room
};

/// Begins a panel whose own point `anchor` (0..1) lies at that point of the window, a margin away from the edges and
/// from the bar. `ImGui::End` is to be called after it, whatever it returns.
bool begin_panel(char const* name, ImVec2 anchor, float opacity, OverlayFrame const& frame,
                 PanelKind kind = PanelKind::told) {
    ImVec2 const size = ImGui::GetIO().DisplaySize;
    float const margin = ImGui::GetFontSize();
    ImVec2 const place(margin + anchor.x * (size.x - 2 * margin),
                       margin + anchor.y * (size.y - frame.bar_height - 2 * margin));
    ImGui::SetNextWindowPos(place, ImGuiCond_Always, anchor);
    ImGui::SetNextWindowBgAlpha(opacity);
    ImGuiWindowFlags const inputs = kind == PanelKind::told ? ImGuiWindowFlags_NoInputs
                                    : kind == PanelKind::takes_keys
                                        ? ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoNavFocus
                                        : ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoNav;
    ImGuiWindowFlags const bars = kind == PanelKind::scrolls ? 0 : ImGuiWindowFlags_NoScrollbar;
    return ImGui::Begin(name, nullptr,
                        ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse |
                            ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings |
                            ImGuiWindowFlags_NoFocusOnAppearing | inputs | bars);
}

/// A field beside its name; true when it was ended by Enter.
bool text_field(char const* name, std::string& text, ImGuiInputTextFlags flags, OverlayFrame& frame) {
    std::array<char, 300> buffer{};
    std::copy_n(text.begin(), std::min(text.size(), buffer.size() - 1), buffer.begin());
    ImGui::SetNextItemWidth(20 * ImGui::GetFontSize());
    bool const entered =
        ImGui::InputText(name, buffer.data(), buffer.size(),
                         flags | ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
    // Esc gives back what was there; where nothing was typed it is as elsewhere.
    if (ImGui::IsItemDeactivated() && ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape)) &&
        text == buffer.data()) {
        frame.actions.commands.push_back(Command::escape);
    }
    text = buffer.data();
    return entered;
}

/// Of a window along the lower edge, as the bar is, the next tooltip stands above it: below the pointer it would lie
/// over the buttons beside.
void place_tooltip() {
    ImVec2 const display = ImGui::GetIO().DisplaySize;
    ImVec2 const window = ImGui::GetWindowPos();
    if (window.x == 0 && window.y + ImGui::GetWindowHeight() >= display.y) {
        float const place = std::clamp(ImGui::GetMousePos().x / display.x, 0.0f, 1.0f);
        ImGui::SetNextWindowPos(ImVec2(place * display.x, window.y), ImGuiCond_Always, ImVec2(place, 1));
    }
}

void draw_server_fields(AddressField const& field, NamedServer& typed, OverlayFrame& frame) {
    float const begin = ImGui::GetCursorPosX() + ImGui::CalcTextSize("server: ").x;
    auto const label = [begin](char const* text) {
        ImGui::AlignTextToFramePadding();
        ImGui::TextUnformatted(text);
        ImGui::SameLine(begin);
    };
    ImGui::Separator();
    label("server:");
    auto const give_keys = [&](ServerField to) {
        if (field.takes_keys == to && frame.had_keys != to) {
            ImGui::SetKeyboardFocusHere();
        }
    };
    give_keys(ServerField::address);
    bool entered = text_field("##address", typed.address, 0, frame);
    tooltip("HOST or HOST:PORT, where framelet-server listens");
    ImGui::SameLine();
    bool tls = field.always_tls || asks_for_tls(typed.address);
    ImGui::BeginDisabled(field.always_tls);
    if (ImGui::Checkbox("TLS", &tls)) {
        typed.address = with_tls(typed.address, tls);
    }
    ImGui::EndDisabled();
    tooltip(field.always_tls ? "the command line says so"
                             : "encrypt the connection, as servers beyond this machine ask");
    label("token:");
    give_keys(ServerField::token);
    entered = text_field("##token", typed.token, ImGuiInputTextFlags_Password, frame) || entered;
    tooltip(
        "what the server's --token-file has. Empty: as on the command line, and none on the same machine as the same "
        "user. It is not kept");
    ImGui::SameLine();
    if ((ImGui::Button("connect") || entered) && !typed.address.empty()) {
        frame.actions.server = typed;
    }
    for (std::string const& address : field.recent) {
        if (ImGui::SmallButton(address.c_str())) {
            typed.address = address;
            frame.actions.server = typed;
        }
        tooltip("connect to it as before");
    }
    ImGui::Separator();
    button("open a scene file ...", Command::open_file, frame);
    ImGui::NewLine();
}

} // namespace

void take_area(OverlayFrame& frame) {
    ImVec2 const from = ImGui::GetWindowPos();
    ImVec2 const size = ImGui::GetWindowSize();
    frame.areas.push_back({from, ImVec2(from.x + size.x, from.y + size.y)});
}

void tooltip(std::string const& text) {
    if (ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) {
        place_tooltip();
        ImGui::PushStyleVar(ImGuiStyleVar_Alpha, 1); // the tooltip is not as pale as what cannot be used
        ImGui::BeginTooltip();
        ImGui::PushTextWrapPos(36 * ImGui::GetFontSize());
        ImGui::TextUnformatted(text.c_str());
        ImGui::PopTextWrapPos();
        ImGui::EndTooltip();
        ImGui::PopStyleVar();
    }
}

void begin_lack(std::string const& lacks) {
    ImGui::BeginDisabled(!lacks.empty());
}

void end_lack(std::string const& lacks, std::string const& tip) {
    ImGui::EndDisabled();
    tooltip(lacks.empty() ? tip : lacks);
}

void button(char const* label, Command command, OverlayFrame& frame, std::string const& lacks) {
    begin_lack(lacks);
    if (ImGui::Button(label)) {
        frame.actions.commands.push_back(command);
    }
    end_lack(lacks, tip_of(command));
    ImGui::SameLine();
}

std::string tip_of(Command command) {
    std::string const tip = with_keys(help_text(command), command);
    return command == Command::screenshot ? tip + "\n" + tip_of(Command::screenshot_with_depth) : tip;
}

void draw_statistics(StatisticsPanel const& panel, OverlayFrame& frame) {
    if (begin_panel("statistics", {0, 0}, 0.75f, frame, PanelKind::takes_mouse)) {
        constexpr float room_for_plots = 34; // font sizes
        bool const has_plots = ImGui::GetIO().DisplaySize.x > room_for_plots * ImGui::GetFontSize();
        if (ImGui::BeginTable("figures", has_plots ? 3 : 2, ImGuiTableFlags_SizingFixedFit)) {
            for (Plot const& figure : panel.plots) {
                figure_cells(figure.name, figure.value);
                if (has_plots) {
                    plot(figure);
                }
            }
            ImGui::EndTable();
        }
        table("rows", panel.rows);
        if (ImGui::SmallButton(panel.shows_details ? "- details###details" : "+ details###details")) {
            frame.actions.commands.push_back(Command::toggle_details);
        }
        tooltip(with_keys("figures for who looks into what it costs", Command::toggle_details));
        if (panel.shows_details) {
            table("details", panel.details);
        }
        take_area(frame);
        frame.left_width = ImGui::GetWindowPos().x + ImGui::GetWindowWidth();
    }
    ImGui::End();
}

void draw_legend(Legend const& legend, OverlayFrame& frame) {
    if (begin_panel("legend", {1, 1}, 0.75f, frame, PanelKind::takes_mouse)) {
        ImGui::BeginGroup();
        ImGui::TextUnformatted(legend.title.c_str());
        if (!legend.newest.empty()) {
            draw_ramp(legend);
        }
        if (!legend.remark.empty()) {
            ImGui::TextUnformatted(legend.remark.c_str());
        }
        ImGui::EndGroup();
        tooltip(legend.tip);
        take_area(frame);
    }
    ImGui::End();
}

void draw_help(std::span<HelpGroup const> groups, OverlayFrame& frame) {
    ImGuiStyle const& style = ImGui::GetStyle();
    ImVec2 const window = ImGui::GetIO().DisplaySize;
    float const font = ImGui::GetFontSize();
    ImVec2 const room(window.x - 2 * font, window.y - frame.bar_height - 2 * font);
    float name_width = 0;
    float text_width = 0;
    for (HelpGroup const& group : groups) {
        for (auto const& [name, text] : group.rows) {
            name_width = std::max(name_width, ImGui::CalcTextSize(name.c_str()).x);
            text_width = std::max(text_width, ImGui::CalcTextSize(text.c_str()).x);
        }
    }
    // Two columns of groups where there is room for that with what they say in two lines; what is still higher than the
    // window is turned by the wheel.
    float const inside = room.x - 2 * style.WindowPadding.x - style.ScrollbarSize - 2 * font;
    float const gaps = 2 * style.CellPadding.x;
    bool const is_wide = inside >= 2 * (name_width + text_width / 2 + 2 * gaps);
    int const columns = is_wide ? 2 : 1;
    float const column = inside / static_cast<float>(columns) - name_width - 2 * gaps;
    ImGui::SetNextWindowSizeConstraints(ImVec2(0, 0), room);
    if (begin_panel("help", {0.5f, 0}, 0.9f, frame, PanelKind::scrolls)) {
        std::size_t const left = is_wide ? left_groups(groups) : groups.size();
        help_column(groups.first(left), name_width, std::min(column, text_width));
        if (is_wide) {
            ImGui::SameLine(0, 2 * font);
            help_column(groups.subspan(left), name_width, std::min(column, text_width));
        }
        if (ImGui::GetScrollMaxY() > 0) { // else drags go through it, to the camera
            take_area(frame);
        }
    }
    ImGui::End();
}

void draw_text(char const* name, ImVec2 anchor, std::string const& text, OverlayFrame const& frame,
               std::optional<float> progress) {
    if (begin_panel(name, anchor, 0.9f, frame)) {
        float const font = ImGui::GetFontSize();
        float const window = ImGui::GetIO().DisplaySize.x;
        bool const is_beside = anchor.x == 1 && anchor.y == 0;
        float const room = is_beside ? std::max(window - frame.left_width - 3 * font, 10 * font) : 0.8f * window;
        ImGui::PushTextWrapPos(std::min(room, 0.8f * window));
        ImGui::TextUnformatted(text.c_str());
        ImGui::PopTextWrapPos();
        if (progress) {
            ImGui::ProgressBar(*progress, ImVec2(std::min(room, 20 * font), 0));
        }
    }
    ImGui::End();
}

void draw_message(OverlayContent const& content, NamedServer& typed, OverlayFrame& frame) {
    AddressField const* const field = content.address ? &*content.address : nullptr;
    if (begin_panel("message", {0.5f, 0.5f}, 0.9f, frame,
                    field != nullptr || content.asks_trust ? PanelKind::takes_keys : PanelKind::told)) {
        ImGui::PushTextWrapPos(ImGui::GetIO().DisplaySize.x * 0.8f);
        ImGui::TextUnformatted(content.message.c_str());
        ImGui::PopTextWrapPos();
        if (content.asks_trust) {
            ImGui::Separator();
            if (ImGui::Button("do not connect")) {
                frame.actions.trusts = false;
            }
            ImGui::SameLine();
            if (ImGui::Button("trust it from now on")) {
                frame.actions.trusts = true;
            }
            take_area(frame);
        }
        if (field != nullptr) {
            draw_server_fields(*field, typed, frame);
            take_area(frame);
        }
    }
    ImGui::End();
}

} // namespace framelet
