// gltf_shim.cpp -- the one place that knows tinygltf. Copies what is needed into plain C structs.
#include "io/gltf_shim.h"
#include <cstdlib>
#include <cstring>
#include <exception>
#include <new>
#include <string>
#include <vector>
#include <tiny_gltf.h>

namespace {

// Buffers come first in tinygltf's order; once they are read, what it asks for are images: they are not
// there. Those that materials use are read later (gltf_texture.c). Names are those of the source: what tinygltf
// makes of a uri has a space for '+', and lacks a '%' that escapes nothing.
struct files {
    const gltf_source *source;
    size_t next;       // buffer that is asked for
    std::string fault; // why one could not be read

    bool is_buffer() const
    {
        return next < source->num_buffer_files;
    }
};

void keep_fault(void *user, tyn_log_level, const char *message)
{
    static_cast<files *>(user)->fault = message;
}

bool file_exists(const std::string &, void *user)
{
    return static_cast<files *>(user)->is_buffer();
}

std::string same_path(const std::string &path, void *)
{
    return path;
}

bool read_file(std::vector<unsigned char> *out, std::string *, const std::string &, void *user)
{
    files *f = static_cast<files *>(user);
    void *data = nullptr;
    size_t size = 0;
    const tyn_log log = {keep_fault, f, TYN_LOG_ERROR};
    if (!f->is_buffer() ||
        tyn_file_read(f->source->buffer_files[f->next], 1ull << 31, &data, &size, &log)) {
        return false;
    }
    f->next++;
    out->assign(static_cast<unsigned char *>(data), static_cast<unsigned char *>(data) + size);
    std::free(data);
    return true;
}

bool skip_image(tinygltf::Image *, const int, std::string *, std::string *, int, int,
                const unsigned char *, int, void *)
{
    return true;
}

template <typename T> T *allocate(size_t count)
{
    T *p = static_cast<T *>(std::calloc(count ? count : 1, sizeof(T)));
    if (!p) {
        throw std::bad_alloc();
    }
    return p;
}

char *copy(const std::string &s)
{
    char *p = allocate<char>(s.size() + 1);
    std::memcpy(p, s.c_str(), s.size());
    return p;
}

uint32_t *copy(const std::vector<int> &v)
{
    uint32_t *p = allocate<uint32_t>(v.size());
    for (size_t i = 0; i < v.size(); i++) {
        p[i] = uint32_t(v[i]);
    }
    return p;
}

void copy(double *out, const std::vector<double> &v, size_t count)
{
    for (size_t i = 0; i < count && i < v.size(); i++) {
        out[i] = v[i];
    }
}

void copy_node(gltf_node *to, const tinygltf::Node &from)
{
    to->name = copy(from.name);
    to->has_matrix = from.matrix.size() == 16;
    copy(to->matrix, from.matrix, 16);
    to->rotation[3] = to->scale[0] = to->scale[1] = to->scale[2] = 1.0;
    copy(to->translation, from.translation, 3);
    copy(to->rotation, from.rotation, 4);
    copy(to->scale, from.scale, 3);
    to->camera = from.camera;
    to->mesh = from.mesh;
    to->light = -1;
    auto punctual = from.extensions.find("KHR_lights_punctual");
    if (punctual != from.extensions.end() && punctual->second.Has("light")) {
        to->light = punctual->second.Get("light").GetNumberAsInt();
    }
    to->children = copy(from.children);
    to->num_children = uint32_t(from.children.size());
}

void copy_camera(gltf_camera *to, const tinygltf::Camera &from)
{
    to->name = copy(from.name);
    to->orthographic = from.type == "orthographic";
    to->yfov = from.perspective.yfov;
    to->aspect = from.perspective.aspectRatio;
    to->xmag = from.orthographic.xmag;
    to->ymag = from.orthographic.ymag;
}

void copy_model(gltf_model *to, const tinygltf::Model &from)
{
    to->nodes = allocate<gltf_node>(from.nodes.size());
    for (const tinygltf::Node &node : from.nodes) {
        copy_node(&to->nodes[to->num_nodes++], node);
    }
    to->cameras = allocate<gltf_camera>(from.cameras.size());
    for (const tinygltf::Camera &camera : from.cameras) {
        copy_camera(&to->cameras[to->num_cameras++], camera);
    }
    to->buffers = allocate<gltf_bytes>(from.buffers.size());
    for (const tinygltf::Buffer &buffer : from.buffers) {
        gltf_bytes *b = &to->buffers[to->num_buffers++];
        b->data = allocate<uint8_t>(buffer.data.size());
        b->size = buffer.data.size();
        std::memcpy(b->data, buffer.data.data(), b->size);
    }
    to->scene = -1;
    if (!from.scenes.empty()) {
        to->scene = from.defaultScene < 0 ? 0 : from.defaultScene;
        const tinygltf::Scene &scene = from.scenes.at(size_t(to->scene));
        to->scene_name = copy(scene.name);
        to->roots = copy(scene.nodes);
        to->num_roots = uint32_t(scene.nodes.size());
        return;
    }
    std::vector<bool> is_child(from.nodes.size());
    std::vector<int> roots;
    for (const tinygltf::Node &node : from.nodes) {
        for (int child : node.children) {
            is_child.at(size_t(child)) = true;
        }
    }
    for (size_t i = 0; i < from.nodes.size(); i++) {
        if (!is_child[i]) {
            roots.push_back(int(i));
        }
    }
    to->scene_name = copy(std::string());
    to->roots = copy(roots);
    to->num_roots = uint32_t(roots.size());
}

tyn_result read_model(gltf_model *model, const gltf_source *source, const tyn_log *log)
{
    tinygltf::TinyGLTF reader;
    tinygltf::Model parsed;
    std::string error, warning;
    files state = {source, 0, std::string()};
    reader.SetImageLoader(skip_image, nullptr);
    reader.SetFsCallbacks({file_exists, same_path, read_file, nullptr, &state});
    unsigned size = unsigned(source->size);
    bool ok = source->glb
                  ? reader.LoadBinaryFromMemory(&parsed, &error, &warning,
                                                static_cast<const unsigned char *>(source->bytes),
                                                size, source->directory)
                  : reader.LoadASCIIFromString(&parsed, &error, &warning,
                                               static_cast<const char *>(source->bytes), size,
                                               source->directory);
    if (!ok) {
        if (!state.fault.empty()) {
            error = "buffers: " + state.fault;
        }
        for (char &c : error) {
            c = c == '\n' || c == '\r' ? ' ' : c;
        }
        tyn_log_print(log, TYN_LOG_ERROR, "%s: %.300s", source->file,
                      error.empty() ? "not a valid glTF file" : error.c_str());
        return TYN_ERR_PARAMS;
    }
    copy_model(model, parsed);
    return TYN_OK;
}

} // namespace

tyn_result gltf_model_read(gltf_model *model, const gltf_source *source, const tyn_log *log)
{
    const char *file = source->file;
    tyn_result r = TYN_ERR_PARAMS;
    std::memset(model, 0, sizeof *model);
    try {
        r = read_model(model, source, log);
    } catch (const std::bad_alloc &) {
        tyn_log_print(log, TYN_LOG_ERROR, "%s: no memory to read it", file);
        r = TYN_ERR_MEMORY;
    } catch (const std::exception &e) {
        tyn_log_print(log, TYN_LOG_ERROR, "%s: not a valid glTF file: %.300s", file, e.what());
    }
    if (r) {
        gltf_model_finish(model);
    }
    return r;
}

bool gltf_data_uri(const char *uri, gltf_bytes *out)
{
    try {
        std::vector<unsigned char> bytes;
        std::string type;
        if (!tinygltf::IsDataURI(uri) || !tinygltf::DecodeDataURI(&bytes, type, uri, 0, false) ||
            bytes.empty()) {
            return false;
        }
        out->data = allocate<uint8_t>(bytes.size());
        out->size = bytes.size();
        std::memcpy(out->data, bytes.data(), out->size);
        return true;
    } catch (const std::exception &) {
        return false;
    }
}

void gltf_model_finish(gltf_model *model)
{
    for (uint32_t i = 0; i < model->num_nodes; i++) {
        std::free(model->nodes[i].name);
        std::free(model->nodes[i].children);
    }
    for (uint32_t i = 0; i < model->num_cameras; i++) {
        std::free(model->cameras[i].name);
    }
    for (uint32_t i = 0; i < model->num_buffers; i++) {
        std::free(model->buffers[i].data);
    }
    std::free(model->buffers);
    std::free(model->scene_name);
    std::free(model->roots);
    std::free(model->nodes);
    std::free(model->cameras);
    std::memset(model, 0, sizeof *model);
}
