/* The engine's interface: one pointer for each function that the extension uses, got by name at start. */
#ifndef WADI_GODOT_API_H
#define WADI_GODOT_API_H

#include <gdextension_interface.h>
#include <stdbool.h>

/* name of the engine's function, its type in gdextension_interface.h without the prefix */
#define API_FUNCTIONS(X)                                                                                                         \
    X(get_godot_version, GetGodotVersion)                                                                                        \
    X(print_error, PrintError)                                                                                                   \
    X(print_warning, PrintWarning)                                                                                               \
    X(variant_new_nil, VariantNewNil)                                                                                            \
    X(variant_new_copy, VariantNewCopy)                                                                                          \
    X(variant_destroy, VariantDestroy)                                                                                           \
    X(variant_construct, VariantConstruct)                                                                                       \
    X(variant_get_type, VariantGetType)                                                                                          \
    X(variant_can_convert_strict, VariantCanConvertStrict)                                                                       \
    X(get_variant_from_type_constructor, GetVariantFromTypeConstructor)                                                          \
    X(variant_get_ptr_internal_getter, GetVariantGetInternalPtrFunc)                                                             \
    X(variant_get_ptr_builtin_method, VariantGetPtrBuiltinMethod)                                                                \
    X(variant_get_ptr_constructor, VariantGetPtrConstructor)                                                                     \
    X(variant_get_ptr_destructor, VariantGetPtrDestructor)                                                                       \
    X(string_new_with_utf8_chars, StringNewWithUtf8Chars)                                                                        \
    X(string_to_utf8_chars, StringToUtf8Chars)                                                                                   \
    X(string_name_new_with_utf8_chars, StringNameNewWithUtf8Chars)                                                               \
    X(packed_byte_array_operator_index, PackedByteArrayOperatorIndex)                                                            \
    X(packed_byte_array_operator_index_const, PackedByteArrayOperatorIndexConst)                                                 \
    X(packed_float32_array_operator_index, PackedFloat32ArrayOperatorIndex)                                                      \
    X(packed_float32_array_operator_index_const, PackedFloat32ArrayOperatorIndexConst)                                           \
    X(packed_vector2_array_operator_index_const, PackedVector2ArrayOperatorIndexConst)                                           \
    X(array_operator_index, ArrayOperatorIndex)                                                                                  \
    X(array_set_typed, ArraySetTyped)                                                                                            \
    X(dictionary_operator_index, DictionaryOperatorIndex)                                                                        \
    X(object_method_bind_call, ObjectMethodBindCall)                                                                             \
    X(object_method_bind_ptrcall, ObjectMethodBindPtrcall)                                                                       \
    X(global_get_singleton, GlobalGetSingleton)                                                                                  \
    X(object_set_instance, ObjectSetInstance)                                                                                    \
    X(object_get_instance_binding, ObjectGetInstanceBinding)                                                                     \
    X(object_set_instance_binding, ObjectSetInstanceBinding)                                                                     \
    X(object_get_instance_id, ObjectGetInstanceId)                                                                               \
    X(object_get_instance_from_id, ObjectGetInstanceFromId)                                                                      \
    X(object_cast_to, ObjectCastTo)                                                                                              \
    X(ref_get_object, RefGetObject)                                                                                              \
    X(ref_set_object, RefSetObject)                                                                                              \
    X(classdb_construct_object2, ClassdbConstructObject2)                                                                        \
    X(classdb_get_method_bind, ClassdbGetMethodBind)                                                                             \
    X(classdb_get_class_tag, ClassdbGetClassTag)                                                                                 \
    X(classdb_register_extension_class4, ClassdbRegisterExtensionClass4)                                                         \
    X(classdb_register_extension_class_method, ClassdbRegisterExtensionClassMethod)                                              \
    X(classdb_register_extension_class_integer_constant, ClassdbRegisterExtensionClassIntegerConstant)                           \
    X(classdb_register_extension_class_property, ClassdbRegisterExtensionClassProperty)                                          \
    X(classdb_register_extension_class_signal, ClassdbRegisterExtensionClassSignal)                                              \
    X(classdb_unregister_extension_class, ClassdbUnregisterExtensionClass)

typedef struct Api {
#define API_FIELD(name, type) GDExtensionInterface##type name;
    API_FUNCTIONS(API_FIELD)
#undef API_FIELD
    GDExtensionInterfaceGetProcAddress get_proc_address;
    GDExtensionClassLibraryPtr extension; /* this extension's token */
} Api;
extern Api api;

/** Gets every function; false and a message of the engine where one is missing (Godot before 4.4). */
bool load_api(GDExtensionInterfaceGetProcAddress get_proc_address, GDExtensionClassLibraryPtr library);

/** A warning or an error in the engine's log, with printf's format; "Wadi: " goes ahead. */
void log_warning(const char* format, ...) __attribute__((format(printf, 1, 2)));
void log_error(const char* format, ...) __attribute__((format(printf, 1, 2)));

#endif
