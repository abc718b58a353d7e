// OpenGL without a window, by OSMesa or EGL, loaded when a scene is drawn.
#include "render/scene/scene_parts.h"

#include <assert.h>
#include <dlfcn.h>
#include <stdlib.h>
#include <string.h>

// The few names of OpenGL, EGL and OSMesa that are needed, so that no header of theirs
// is. Values from the Khronos registry and Mesa's GL/osmesa.h.
enum {
    GL_TRIANGLES = 0x0004,
    GL_DEPTH_TEST = 0x0B71,
    GL_SCISSOR_TEST = 0x0C11,
    GL_UNSIGNED_BYTE = 0x1401,
    GL_UNSIGNED_INT = 0x1405,
    GL_FLOAT = 0x1406,
    GL_RENDERER = 0x1F01,
    GL_VERSION = 0x1F02,
    GL_RGBA = 0x1908,
    GL_DEPTH_BUFFER_BIT = 0x0100,
    GL_COLOR_BUFFER_BIT = 0x4000,
    GL_RGBA8 = 0x8058,
    GL_VERTEX_ARRAY = 0x8074,
    GL_COLOR_ARRAY = 0x8076,
    GL_BGRA = 0x80E1,
    GL_DEPTH_COMPONENT24 = 0x81A6,
    GL_UNSIGNED_INT_8_8_8_8_REV = 0x8367,
    GL_FRAMEBUFFER_COMPLETE = 0x8CD5,
    GL_COLOR_ATTACHMENT0 = 0x8CE0,
    GL_DEPTH_ATTACHMENT = 0x8D00,
    GL_FRAMEBUFFER = 0x8D40,
    GL_RENDERBUFFER = 0x8D41,

    EGL_PLATFORM_SURFACELESS = 0x31DD,
    EGL_OPENGL_API = 0x30A2,
    EGL_OPENGL_BIT = 0x0008,
    EGL_PBUFFER_BIT = 0x0001,
    EGL_SURFACE_TYPE = 0x3033,
    EGL_NONE = 0x3038,
    EGL_RENDERABLE_TYPE = 0x3040,
    EGL_HEIGHT = 0x3056,
    EGL_WIDTH = 0x3057,
};

// Every function of OpenGL that is called: result, name, arguments.
#define GL_FUNCTIONS(X)                                                                  \
    X(const unsigned char *, GetString, (unsigned name))                                 \
    X(void, Viewport, (int x, int y, int width, int height))                             \
    X(void, Scissor, (int x, int y, int width, int height))                              \
    X(void, Enable, (unsigned what))                                                     \
    X(void, ClearColor, (float red, float green, float blue, float alpha))               \
    X(void, Clear, (unsigned what))                                                      \
    X(void, ReadPixels,                                                                  \
      (int x, int y, int width, int height, unsigned format, unsigned type, void *to))   \
    X(unsigned, GetError, (void))                                                        \
    X(void, GenFramebuffers, (int count, unsigned *names))                               \
    X(void, BindFramebuffer, (unsigned target, unsigned name))                           \
    X(unsigned, CheckFramebufferStatus, (unsigned target))                               \
    X(void, GenRenderbuffers, (int count, unsigned *names))                              \
    X(void, BindRenderbuffer, (unsigned target, unsigned name))                          \
    X(void, RenderbufferStorage,                                                         \
      (unsigned target, unsigned format, int width, int height))                         \
    X(void, FramebufferRenderbuffer,                                                     \
      (unsigned target, unsigned attachment, unsigned kind, unsigned name))              \
    X(void, EnableClientState, (unsigned what))                                          \
    X(void, VertexPointer, (int size, unsigned type, int stride, const void *from))      \
    X(void, ColorPointer, (int size, unsigned type, int stride, const void *from))       \
    X(void, DrawElements, (unsigned mode, int count, unsigned type, const void *offset))

typedef void (*any_function)(void);
typedef any_function (*function_finder)(const char *name);

struct gl_offscreen {
    scene_renderer library;
    void *handle; // of the library
    function_finder find;
    void *context, *display, *surface;
    unsigned char *small; // OSMesa's own picture, which nothing is drawn into
    int width, height;    // of the picture [pixels]
    int rows;             // of it that are drawn at once
#define GL_MEMBER(result, name, arguments) result(*name) arguments;
    GL_FUNCTIONS(GL_MEMBER)
#undef GL_MEMBER
};

enum { SMALL = 16 }; // edge of the surface that a context insists on [pixels]

// A function of a library; ISO C has no other conversion from an object pointer to a
// function pointer.
static bool load(void *handle, const char *name, void *function)
{
    void *found = dlsym(handle, name);
    memcpy(function, &found, sizeof found);
    return found != NULL;
}

// Makes the context the one that OpenGL's functions mean.
static bool make_current(gl_offscreen *g)
{
    unsigned char (*osmesa)(void *, void *, unsigned, int, int);
    unsigned (*egl)(void *, void *, void *, void *);
    if (g->library == RENDER_OSMESA) {
        return load(g->handle, "OSMesaMakeCurrent", &osmesa) &&
               osmesa(g->context, g->small, GL_UNSIGNED_BYTE, SMALL, SMALL);
    }
    return load(g->handle, "eglMakeCurrent", &egl) &&
           egl(g->display, g->surface, g->surface, g->context);
}

// ---- OSMesa

// A context of OSMesa, which draws without a driver.
static status open_osmesa(gl_offscreen *g, fault *f)
{
    // the library, where it is installed
    void *(*create)(unsigned, int, int, int, void *);
    g->handle = dlopen("libOSMesa.so.8", RTLD_NOW | RTLD_LOCAL);
    FAULT_IF(g->handle == NULL, f, STATUS_CANNOT_WRITE,
             "OSMesa is not installed (libOSMesa.so.8): install libosmesa6, or "
             "choose --gl=egl or --gl=cairo");

    // a context without a window
    FAULT_IF(!load(g->handle, "OSMesaCreateContextExt", &create) ||
                 !load(g->handle, "OSMesaGetProcAddress", &g->find),
             f, STATUS_CANNOT_WRITE,
             "libOSMesa.so.8 is too old: expected one of Mesa 17 or later");
    g->small = g_malloc0_n(SMALL * SMALL, 4);
    g->context = create(GL_RGBA, 0, 0, 0, NULL);
    FAULT_IF(g->context == NULL || !make_current(g), f, STATUS_CANNOT_WRITE,
             "OSMesa gives no context of OpenGL");
    return STATUS_OK;
}

// ---- EGL

// What EGL lacks, and what to do about it.
static status complain_egl(fault *f, const char *what)
{
    return fault_set(f, STATUS_CANNOT_WRITE,
                     "EGL %s: install libegl1 and libgl1-mesa-dri, or choose --gl=osmesa "
                     "or --gl=cairo",
                     what);
}

// The display without a screen. It is kept until the end of the process: closing it would
// unload drivers that hold memory.
static void *egl_display(void *handle)
{
    static void *display;
    void *(*get)(unsigned, void *, const void *);
    unsigned (*initialise)(void *, int *, int *);
    function_finder find;

    if (display != NULL || !load(handle, "eglGetProcAddress", &find) ||
        !load(handle, "eglInitialize", &initialise)) {
        return display;
    }

    // a platform without windows; what Mesa has to say on the way is said by the fault
    any_function found = find("eglGetPlatformDisplayEXT");
    memcpy(&get, &found, sizeof found);
    setenv("EGL_LOG_LEVEL", "fatal", 0);
    // in software, as OSMesa is: pictures do not depend on a graphics card
    setenv("LIBGL_ALWAYS_SOFTWARE", "1", 0);
    void *opened = NULL;
    if (get != NULL) {
        opened = get(EGL_PLATFORM_SURFACELESS, NULL, NULL);
    }
    if (opened != NULL && initialise(opened, NULL, NULL)) {
        display = opened;
    }
    return display;
}

// A context of EGL on a display without a screen.
static status open_egl(gl_offscreen *g, fault *f)
{
    static const int config_wanted[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT,
                                        EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
    static const int surface_wanted[] = {EGL_WIDTH, SMALL, EGL_HEIGHT, SMALL, EGL_NONE};
    unsigned (*bind)(unsigned), (*choose)(void *, const int *, void **, int, int *);
    void *(*create_context)(void *, void *, void *, const int *);
    void *(*create_surface)(void *, void *, const int *), *config;
    int count = 0;

    // the library and its display
    g->handle = dlopen("libEGL.so.1", RTLD_NOW | RTLD_LOCAL);
    if (g->handle == NULL) {
        return complain_egl(f, "is not installed (libEGL.so.1)");
    }
    g->display = egl_display(g->handle);
    if (g->display == NULL) {
        return complain_egl(f, "gives no display without a screen");
    }

    // OpenGL and a configuration for small surfaces
    if (!load(g->handle, "eglBindAPI", &bind) ||
        !load(g->handle, "eglChooseConfig", &choose) ||
        !load(g->handle, "eglCreateContext", &create_context) ||
        !load(g->handle, "eglCreatePbufferSurface", &create_surface) ||
        !load(g->handle, "eglGetProcAddress", &g->find) || !bind(EGL_OPENGL_API) ||
        !choose(g->display, config_wanted, &config, 1, &count) || count < 1) {
        return complain_egl(f, "knows no OpenGL");
    }

    g->surface = create_surface(g->display, config, surface_wanted);
    g->context = create_context(g->display, config, NULL, NULL);
    if (g->surface == NULL || g->context == NULL || !make_current(g)) {
        return complain_egl(f, "gives no context of OpenGL");
    }
    return STATUS_OK;
}

// ---- OpenGL

// Looks up the functions of OpenGL. False if one is missing.
static bool load_functions(gl_offscreen *g)
{
    any_function found;
    bool all = true;
#define GL_LOAD(result, name, arguments)                                                 \
    found = g->find("gl" #name);                                                         \
    memcpy(&g->name, &found, sizeof found);                                              \
    all = all && found != NULL;
    GL_FUNCTIONS(GL_LOAD)
#undef GL_LOAD
    return all;
}

// Gives the context a picture of its own size to draw into.
static bool make_framebuffer(gl_offscreen *g)
{
    // colours of 8 bits, and depths
    static const unsigned formats[] = {GL_RGBA8, GL_DEPTH_COMPONENT24};
    static const unsigned places[] = {GL_COLOR_ATTACHMENT0, GL_DEPTH_ATTACHMENT};
    unsigned framebuffer, buffers[2];

    // a framebuffer, and buffers for both
    g->GenFramebuffers(1, &framebuffer);
    g->BindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    g->GenRenderbuffers(2, buffers);

    for (int i = 0; i < 2; i++) {
        g->BindRenderbuffer(GL_RENDERBUFFER, buffers[i]);
        g->RenderbufferStorage(GL_RENDERBUFFER, formats[i], g->width, g->rows);
        g->FramebufferRenderbuffer(GL_FRAMEBUFFER, places[i], GL_RENDERBUFFER,
                                   buffers[i]);
    }
    return g->CheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
}

// Opens the context of a library and makes it ready to draw.
static status prepare_offscreen(gl_offscreen *g, char name[RENDERER_NAME], fault *f)
{
    const char *library = g->library == RENDER_OSMESA ? "OSMesa" : "EGL";

    // a context with OpenGL's functions
    if (g->library == RENDER_OSMESA) {
        TRY(open_osmesa(g, f));
    } else {
        TRY(open_egl(g, f));
    }
    FAULT_IF(!load_functions(g), f, STATUS_CANNOT_WRITE, "%s lacks functions of OpenGL 3",
             library);
    FAULT_IF(!make_framebuffer(g), f, STATUS_CANNOT_WRITE,
             "%s cannot draw a picture of %d x %d pixels", library, g->width, g->rows);

    // what draws, as the picture's notes name it
    snprintf(name, RENDERER_NAME, "%s, %s, OpenGL %s", library,
             (const char *)g->GetString(GL_RENDERER),
             (const char *)g->GetString(GL_VERSION));
    g->Enable(GL_DEPTH_TEST);
    g->Enable(GL_SCISSOR_TEST);
    g->EnableClientState(GL_VERTEX_ARRAY);
    g->EnableClientState(GL_COLOR_ARRAY);
    g->ClearColor(0, 0, 0, 0);
    return STATUS_OK;
}

status gl_offscreen_create(gl_offscreen **out, scene_renderer library, int width,
                           int height, int rows, char name[RENDERER_NAME], fault *f)
{
    assert(width > 0 && height > 0 && rows > 0);
    g_autoptr(gl_offscreen) g = g_new0(gl_offscreen, 1);
    *out = NULL;
    g->library = library;
    g->width = width;
    g->height = height;
    g->rows = rows;
    TRY(prepare_offscreen(g, name, f));
    *out = g_steal_pointer(&g);
    return STATUS_OK;
}

void gl_offscreen_destroy(gl_offscreen *g)
{
    if (g == NULL) {
        return;
    }

    // the context takes OpenGL's objects with it
    if (g->library == RENDER_OSMESA) {
        void (*destroy)(void *);
        if (g->context != NULL && load(g->handle, "OSMesaDestroyContext", &destroy)) {
            destroy(g->context);
        }
        g_free(g->small);
    } else {
        unsigned (*release)(void *, void *, void *, void *), (*destroy)(void *, void *);
        if (g->display != NULL && load(g->handle, "eglMakeCurrent", &release)) {
            release(g->display, NULL, NULL, NULL);
        }
        if (g->context != NULL && load(g->handle, "eglDestroyContext", &destroy)) {
            destroy(g->display, g->context);
        }
        if (g->surface != NULL && load(g->handle, "eglDestroySurface", &destroy)) {
            destroy(g->display, g->surface);
        }
    }

    // the library stays: its threads may still be ending
    g_free(g);
}

// Draws triangles and reads the pixels of a region back.
status gl_offscreen_draw(gl_offscreen *g, const gl_triangles *t, pixel_box region,
                         uint32_t *pixels, fault *f)
{
    FAULT_IF(!make_current(g), f, STATUS_CANNOT_WRITE, "OpenGL's context is lost");

    // only the part of the picture that is wanted, moved to the first of the rows
    assert(region.height <= g->rows);
    g->Viewport(0, -region.y, g->width, g->height);
    g->Scissor(region.x, 0, region.width, region.height);
    g->Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);

    // triangles in, which come lit and in clip coordinates; pixels out
    g->VertexPointer(4, GL_FLOAT, sizeof *t->vertices, t->vertices->place);
    g->ColorPointer(4, GL_FLOAT, sizeof *t->vertices, t->vertices->colour);
    g->DrawElements(GL_TRIANGLES, (int)t->corner_count, GL_UNSIGNED_INT, t->corners);
    g->ReadPixels(region.x, 0, region.width, region.height, GL_BGRA,
                  GL_UNSIGNED_INT_8_8_8_8_REV, pixels);

    // one question for all calls
    unsigned error = g->GetError();
    FAULT_IF(error != 0, f, STATUS_CANNOT_WRITE, "OpenGL refused to draw (error 0x%x)",
             error);
    return STATUS_OK;
}
