// panel.cpp -- Dear ImGui, with its own backends for GLFW and Vulkan, as plain C functions.
#include "view/panel.h"
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_vulkan.h>
#include <imgui.h>
#include <math.h>
#include <stdio.h>

// ---- life -------------------------------------------------------------------------------------

void panel_open(GLFWwindow *window)
{
    IMGUI_CHECKVERSION();
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr; // leaves no file behind
    ImGui::GetIO().LogFilename = nullptr;
    ImGui::StyleColorsDark();
    ImGui::GetStyle().WindowRounding = 4;
    ImGui_ImplGlfw_InitForVulkan(window, true);
}

void panel_close(void)
{
    if (ImGui::GetCurrentContext()) {
        ImGui_ImplGlfw_Shutdown();
        ImGui::DestroyContext();
    }
}

bool panel_open_device(const panel_device *device)
{
    ImGui_ImplVulkan_InitInfo info = {};
    info.Instance = device->instance;
    info.PhysicalDevice = device->physical_device;
    info.Device = device->device;
    info.QueueFamily = device->queue_family;
    info.Queue = device->queue;
    info.DescriptorPool = device->pool;
    info.MinImageCount = device->min_images < 2 ? 2 : device->min_images;
    info.ImageCount =
        device->num_images < info.MinImageCount ? info.MinImageCount : device->num_images;
    info.MSAASamples = VK_SAMPLE_COUNT_1_BIT;
    return ImGui_ImplVulkan_Init(&info, device->pass);
}

void panel_record_font(VkCommandBuffer cmd)
{
    ImGui_ImplVulkan_CreateFontsTexture(cmd);
}

void panel_font_is_done(void)
{
    ImGui_ImplVulkan_DestroyFontUploadObjects();
}

void panel_close_device(void)
{
    if (ImGui::GetCurrentContext() && ImGui::GetIO().BackendRendererUserData) {
        ImGui_ImplVulkan_Shutdown();
    }
}

// ---- a frame ----------------------------------------------------------------------------------

void panel_begin(void)
{
    ImGui_ImplVulkan_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
}

void panel_end(void)
{
    ImGui::Render();
}

void panel_record(VkCommandBuffer cmd)
{
    ImGui_ImplVulkan_RenderDrawData(ImGui::GetDrawData(), cmd);
}

bool panel_has_mouse(void)
{
    return ImGui::GetIO().WantCaptureMouse;
}

bool panel_has_keyboard(void)
{
    return ImGui::GetIO().WantTextInput;
}

// ---- widgets ----------------------------------------------------------------------------------

void panel_window(const char *title, float width, float height)
{
    ImGui::SetNextWindowPos(ImVec2(8, 8), ImGuiCond_Once);
    ImGui::SetNextWindowSizeConstraints(ImVec2(width, 0), ImVec2(width, height));
    ImGui::Begin(title, nullptr, ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoNav);
    ImGui::PushItemWidth(0.58f * width);
    ImGui::PushAllowKeyboardFocus(false); // Tab is a key of the viewer
}

void panel_window_end(void)
{
    ImGui::PopAllowKeyboardFocus();
    ImGui::PopItemWidth();
    ImGui::End();
}

bool panel_section(const char *title, bool open)
{
    return ImGui::CollapsingHeader(title, open ? ImGuiTreeNodeFlags_DefaultOpen : 0);
}

void panel_text(const char *text)
{
    ImGui::PushTextWrapPos(0);
    ImGui::TextUnformatted(text);
    ImGui::PopTextWrapPos();
}

void panel_row(const char *left, const char *right)
{
    ImGui::TextUnformatted(left);
    ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - ImGui::CalcTextSize(right).x);
    ImGui::TextUnformatted(right);
}

bool panel_slider(const char *label, float *value, float low, float high, bool logarithmic)
{
    const ImGuiSliderFlags flags = ImGuiSliderFlags_AlwaysClamp;
    return ImGui::SliderFloat(label, value, low, high, "%.3g",
                              logarithmic ? flags | ImGuiSliderFlags_Logarithmic : flags);
}

bool panel_color(const char *label, float rgb[3])
{
    const bool changed = ImGui::ColorEdit3(label, rgb,
                                           ImGuiColorEditFlags_Float | ImGuiColorEditFlags_HDR |
                                               ImGuiColorEditFlags_NoOptions);
    for (int i = 0; i < 3; i++) {
        rgb[i] = rgb[i] < 0 ? 0 : rgb[i];
    }
    return changed;
}

bool panel_choice(const char *label, int *index, const char *const *names, int count)
{
    return ImGui::Combo(label, index, names, count);
}

bool panel_checkbox(const char *label, bool *value)
{
    return ImGui::Checkbox(label, value);
}

bool panel_button(const char *label)
{
    return ImGui::Button(label);
}

void panel_curve(const char *label, const float *values, int count)
{
    const float line = ImGui::GetTextLineHeight(), width = ImGui::GetContentRegionAvail().x;
    const ImVec2 size(width, 6 * line), at = ImGui::GetCursorScreenPos();
    const ImVec2 end(at.x + size.x, at.y + size.y);
    const ImU32 faint = ImGui::GetColorU32(ImGuiCol_TextDisabled), bright = 0xff20e0ff;
    ImDrawList *list = ImGui::GetWindowDrawList();
    ImGui::Dummy(size);
    list->AddRectFilled(at, end, ImGui::GetColorU32(ImGuiCol_FrameBg));
    list->AddText(ImVec2(at.x + 3, end.y - line), faint, label);
    float low = INFINITY, high = 0;
    for (int i = 0; i < count; i++) {
        low = values[i] > 0 ? fminf(low, values[i]) : low;
        high = fmaxf(high, values[i]);
    }
    if (!(low <= high)) {
        return;
    }
    const float bottom = floorf(log10f(low)), decades = fmaxf(ceilf(log10f(high)) - bottom, 1);
    for (float i = 0; i <= decades; i++) {
        char text[32];
        snprintf(text, sizeof text, "%g %%", 100 * pow(10, bottom + i));
        const float y = end.y - size.y * i / decades, x = end.x - ImGui::CalcTextSize(text).x - 3;
        list->AddLine(ImVec2(at.x, y), ImVec2(end.x, y), ImGui::GetColorU32(ImGuiCol_Separator));
        list->AddText(ImVec2(x, i > 0 ? y : y - line), faint, text);
    }
    ImVec2 last;
    for (int i = 0; i < count; i++) {
        if (values[i] > 0) {
            last.x = at.x + size.x * (float)i / (float)(count > 1 ? count - 1 : 1);
            last.y = end.y - size.y * (log10f(values[i]) - bottom) / decades;
            list->PathLineTo(last);
        }
    }
    list->PathStroke(bright, 0, 1.5f);
    list->AddCircleFilled(last, 2.5f, bright);
}

void panel_push(int id)
{
    ImGui::PushID(id);
}

void panel_pop(void)
{
    ImGui::PopID();
}

// ---- over the picture -------------------------------------------------------------------------

void panel_line(float x0, float y0, float x1, float y1, uint32_t abgr)
{
    ImGui::GetBackgroundDrawList()->AddLine(ImVec2(x0, y0), ImVec2(x1, y1), abgr, 1.5f);
}

void panel_label(float x, float y, const char *text)
{
    const ImVec2 size = ImGui::CalcTextSize(text);
    ImGui::GetBackgroundDrawList()->AddRectFilled(
        ImVec2(x - 3, y - 2), ImVec2(x + size.x + 3, y + size.y + 2), 0xb0000000);
    ImGui::GetBackgroundDrawList()->AddText(ImVec2(x, y), 0xffffffff, text);
}
