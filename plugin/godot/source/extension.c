/* The extension's entry, named in wadi.gdextension. */
#include "engine/class_docs.h"
#include "engine/engine.h"
#include "scene/float.h"
#include "scene/level.h"
#include "scene/terrain.h"

#include <wadi/wadi.h>

static const Class* const classes[] = {&level_class, &terrain_class, &float_class};
enum { CLASS_COUNT = sizeof classes / sizeof *classes };

/* The editor alone has help, and the function for it. */
static void add_help(void) {
    const GDExtensionsInterfaceEditorHelpLoadXmlFromUtf8CharsAndLen load =
        (GDExtensionsInterfaceEditorHelpLoadXmlFromUtf8CharsAndLen)(void (*)(void))api.get_proc_address(
            "editor_help_load_xml_from_utf8_chars_and_len");
    for (const ClassDoc* doc = class_docs; load && doc->xml; ++doc) load(doc->xml, (GDExtensionInt)doc->size);
}

static void initialize(void* data, GDExtensionInitializationLevel level) {
    (void)data;
    if (level == GDEXTENSION_INITIALIZATION_EDITOR) add_help();
    if (level != GDEXTENSION_INITIALIZATION_SCENE) return;
    for (int n = 0; n < CLASS_COUNT; ++n) register_class(classes[n]);
}

static void deinitialize(void* data, GDExtensionInitializationLevel level) {
    (void)data;
    if (level != GDEXTENSION_INITIALIZATION_SCENE) return;
    for (int n = CLASS_COUNT - 1; n >= 0; --n) unregister_class(classes[n]);
}

__attribute__((visibility("default"))) GDExtensionBool wadi_godot_init(GDExtensionInterfaceGetProcAddress get_proc_address,
                                                                       GDExtensionClassLibraryPtr library,
                                                                       GDExtensionInitialization* initialization) {
    if (!load_api(get_proc_address, library)) return false;
    if (wadi_get_abi_version() != WADI_ABI_VERSION) {
        log_error("libwadi has ABI version %u, this extension was built for %u", wadi_get_abi_version(), WADI_ABI_VERSION);
        return false;
    }
    initialization->minimum_initialization_level = GDEXTENSION_INITIALIZATION_SCENE;
    initialization->initialize = initialize;
    initialization->deinitialize = deinitialize;
    return true;
}
