#include "window.hpp"

#include <gl/context.hpp>

#include <postfx/error.hpp>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <fmt/format.h>

namespace postfx::host {
namespace {

std::string last_problem() {
    const char* text = nullptr;
    return glfwGetError(&text) == GLFW_NO_ERROR || !text ? "no reason given" : text;
}

} // namespace

Window::Window(int width, int height, const std::string& title, bool debug) {
    if (!glfwInit()) {
        throw Error(fmt::format("no window: {} (without a display, use postfx render)", last_problem()));
    }
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_OPENGL_DEBUG_CONTEXT, debug ? GLFW_TRUE : GLFW_FALSE);
    window_ = glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr);
    if (!window_) {
        const std::string problem = last_problem();
        glfwTerminate();
        throw Error(fmt::format("no window with OpenGL 4.5: {}", problem));
    }
    glfwMakeContextCurrent(window_);
    gl::load_functions(glfwGetProcAddress);
    if (debug) gl::enable_debug_output();
    glfwSwapInterval(1);
    glfwSetWindowUserPointer(window_, this);
    glfwSetKeyCallback(window_, [](GLFWwindow* window, int key, int, int action, int) {
        if (action == GLFW_PRESS)
            static_cast<Window*>(glfwGetWindowUserPointer(window))->pressed_.push_back(key);
    });
}

Window::~Window() {
    glfwDestroyWindow(window_);
    glfwTerminate();
}

bool Window::should_close() const {
    return glfwWindowShouldClose(window_) != 0;
}

void Window::close() {
    glfwSetWindowShouldClose(window_, GLFW_TRUE);
}

void Window::swap_and_poll() {
    pressed_.clear();
    glfwSwapBuffers(window_);
    glfwPollEvents();
    glm::dvec2 cursor;
    glfwGetCursorPos(window_, &cursor.x, &cursor.y);
    const bool dragging = glfwGetMouseButton(window_, GLFW_MOUSE_BUTTON_RIGHT) == GLFW_PRESS;
    drag_ = dragging ? cursor - cursor_ : glm::dvec2(0);
    cursor_ = cursor;
}

glm::ivec2 Window::size() const {
    glm::ivec2 size;
    glfwGetFramebufferSize(window_, &size.x, &size.y);
    return size;
}

void Window::set_title(const std::string& title) {
    glfwSetWindowTitle(window_, title.c_str());
}

bool Window::is_down(int key) const {
    return glfwGetKey(window_, key) == GLFW_PRESS;
}

} // namespace postfx::host
