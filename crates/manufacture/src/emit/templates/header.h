@HEAD@
#ifndef @GUARD@
#define @GUARD@

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

@PROTOTYPES@@VARIANT@@PARAMETERS@
#ifdef __cplusplus
}
#endif

#endif
