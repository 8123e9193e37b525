/* The part of Godot's extension interface that the scene's sources are compiled against without Godot. What they do not call has
 * no type of its own. */
#ifndef GDEXTENSION_INTERFACE_H
#define GDEXTENSION_INTERFACE_H

#include <stdint.h>

typedef enum {
    GDEXTENSION_VARIANT_TYPE_NIL,
    GDEXTENSION_VARIANT_TYPE_BOOL,
    GDEXTENSION_VARIANT_TYPE_STRING,
    GDEXTENSION_VARIANT_TYPE_VECTOR3,
    GDEXTENSION_VARIANT_TYPE_RECT2I,
    GDEXTENSION_VARIANT_TYPE_DICTIONARY,
    GDEXTENSION_VARIANT_TYPE_ARRAY,
    GDEXTENSION_VARIANT_TYPE_OBJECT,
    GDEXTENSION_VARIANT_TYPE_PACKED_BYTE_ARRAY,
    GDEXTENSION_VARIANT_TYPE_PACKED_FLOAT32_ARRAY
} GDExtensionVariantType;
typedef int64_t GDExtensionInt;
typedef uint64_t GDObjectInstanceID;
typedef void* GDExtensionObjectPtr;
typedef void* GDExtensionClassLibraryPtr;
typedef void* GDExtensionTypePtr;
typedef const void* GDExtensionConstTypePtr;

typedef void (*GDExtensionInterfaceGetProcAddress)(void);
typedef GDObjectInstanceID (*GDExtensionInterfaceObjectGetInstanceId)(const void* object);
typedef GDExtensionObjectPtr (*GDExtensionInterfaceObjectGetInstanceFromId)(GDObjectInstanceID id);
typedef void* (*GDExtensionInterfacePackedVector2ArrayOperatorIndexConst)(const void* array, GDExtensionInt n);
typedef void (*GDExtensionInterfaceVariantDestroy)(void* variant);
typedef void (*GDExtensionInterfaceGetGodotVersion)(void);
typedef void (*GDExtensionInterfacePrintError)(void);
typedef void (*GDExtensionInterfacePrintWarning)(void);
typedef void (*GDExtensionInterfaceVariantNewNil)(void);
typedef void (*GDExtensionInterfaceVariantNewCopy)(void);
typedef void (*GDExtensionInterfaceVariantConstruct)(void);
typedef void (*GDExtensionInterfaceVariantGetType)(void);
typedef void (*GDExtensionInterfaceVariantCanConvertStrict)(void);
typedef void (*GDExtensionInterfaceGetVariantFromTypeConstructor)(void);
typedef void (*GDExtensionInterfaceGetVariantGetInternalPtrFunc)(void);
typedef void (*GDExtensionInterfaceVariantGetPtrBuiltinMethod)(void);
typedef void (*GDExtensionInterfaceVariantGetPtrConstructor)(void);
typedef void (*GDExtensionInterfaceVariantGetPtrDestructor)(void);
typedef void (*GDExtensionInterfaceStringNewWithUtf8Chars)(void);
typedef void (*GDExtensionInterfaceStringToUtf8Chars)(void);
typedef void (*GDExtensionInterfaceStringNameNewWithUtf8Chars)(void);
typedef void (*GDExtensionInterfacePackedByteArrayOperatorIndex)(void);
typedef void (*GDExtensionInterfacePackedByteArrayOperatorIndexConst)(void);
typedef void (*GDExtensionInterfacePackedFloat32ArrayOperatorIndex)(void);
typedef void (*GDExtensionInterfacePackedFloat32ArrayOperatorIndexConst)(void);
typedef void (*GDExtensionInterfaceArrayOperatorIndex)(void);
typedef void (*GDExtensionInterfaceArraySetTyped)(void);
typedef void (*GDExtensionInterfaceDictionaryOperatorIndex)(void);
typedef void (*GDExtensionInterfaceObjectMethodBindCall)(void);
typedef void (*GDExtensionInterfaceObjectMethodBindPtrcall)(void);
typedef void (*GDExtensionInterfaceGlobalGetSingleton)(void);
typedef void (*GDExtensionInterfaceObjectSetInstance)(void);
typedef void (*GDExtensionInterfaceObjectGetInstanceBinding)(void);
typedef void (*GDExtensionInterfaceObjectSetInstanceBinding)(void);
typedef void (*GDExtensionInterfaceObjectCastTo)(void);
typedef void (*GDExtensionInterfaceRefGetObject)(void);
typedef void (*GDExtensionInterfaceRefSetObject)(void);
typedef void (*GDExtensionInterfaceClassdbConstructObject2)(void);
typedef void (*GDExtensionInterfaceClassdbGetMethodBind)(void);
typedef void (*GDExtensionInterfaceClassdbGetClassTag)(void);
typedef void (*GDExtensionInterfaceClassdbRegisterExtensionClass4)(void);
typedef void (*GDExtensionInterfaceClassdbRegisterExtensionClassMethod)(void);
typedef void (*GDExtensionInterfaceClassdbRegisterExtensionClassIntegerConstant)(void);
typedef void (*GDExtensionInterfaceClassdbRegisterExtensionClassProperty)(void);
typedef void (*GDExtensionInterfaceClassdbRegisterExtensionClassSignal)(void);
typedef void (*GDExtensionInterfaceClassdbUnregisterExtensionClass)(void);

#endif
