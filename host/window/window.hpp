// A GLFW window with an OpenGL 4.5 core context, current from construction on.
#pragma once

#include <glm/glm.hpp>

#include <string>
#include <vector>

struct GLFWwindow;

namespace postfx::host {

class Window {
public:
    /// Throws Error: no display, or no OpenGL 4.5.
    Window(int width, int height, const std::string& title, bool debug);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    bool should_close() const;
    void close();
    /// Show what was drawn, then take in events.
    void swap_and_poll();

    /// Of the framebuffer, pixels; 0x0 while the window is minimised.
    glm::ivec2 size() const;
    void set_title(const std::string& title);

    /// GLFW key codes pressed since the last swap_and_poll().
    const std::vector<int>& pressed_keys() const { return pressed_; }
    bool is_down(int key) const;
    /// Pixels that the mouse moved with the right button held, since the last swap_and_poll(); y downwards.
    glm::dvec2 drag() const { return drag_; }

private:
    GLFWwindow* window_ = nullptr;
    std::vector<int> pressed_;
    glm::dvec2 cursor_{0}, drag_{0};
};

} // namespace postfx::host
