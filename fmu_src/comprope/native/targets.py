"""Targets of the native FMUs, and object files of the kernels for each."""

from dataclasses import dataclass

import llvmlite.binding as llvm

from .llvm_ir import PREFIX


@dataclass(frozen=True)
class Target:
    """A system that binaries are made for.

    `system` is its display name; `folder` (FMI 2.0), `platform` (FMI 3.0) and `extension` are defined by FMI, `triple`
    and `cpu` by LLVM; `zig` is the target that zig links for.
    """

    system: str
    folder: str
    platform: str
    extension: str
    triple: str
    cpu: str
    zig: str


_MACOS = "macOS (Intel and Apple)"
# The oldest processor of each kind: wider vector units gain little, and all give the same bits.
TARGETS = {
    "linux": Target("Linux", "linux64", "x86_64-linux", "so", "x86_64-unknown-linux-gnu", "x86-64", "x86_64-linux-gnu.2.17"),
    "linux-arm64": Target(
        "Linux", "aarch64-linux", "aarch64-linux", "so", "aarch64-unknown-linux-gnu", "generic", "aarch64-linux-gnu.2.17"
    ),
    "windows": Target("Windows", "win64", "x86_64-windows", "dll", "x86_64-w64-windows-gnu", "x86-64", "x86_64-windows-gnu"),
    "macos-x86_64": Target(
        _MACOS, "darwin64", "x86_64-darwin", "dylib", "x86_64-apple-macosx11.0.0", "x86-64", "x86_64-macos.11.0"
    ),
    "macos-arm64": Target(
        _MACOS, "darwin64", "aarch64-darwin", "dylib", "arm64-apple-macosx11.0.0", "apple-m1", "aarch64-macos.11.0"
    ),
}


def machine_code(code: str, target: Target) -> bytes:
    """The object file of the LLVM module `code`, optimised without reordering any sum."""
    llvm.initialize_all_targets()
    llvm.initialize_all_asmprinters()
    kind = llvm.Target.from_triple(target.triple)
    machine = kind.create_target_machine(cpu=target.cpu, opt=3, reloc="pic", codemodel="default")
    module = llvm.parse_assembly(code)
    module.triple, module.data_layout = target.triple, str(machine.target_data)
    for function in module.functions:
        if function.name.startswith(PREFIX) and "windows" not in target.triple:
            function.visibility = "hidden"
    tuning = llvm.create_pipeline_tuning_options(speed_level=3)
    tuning.loop_vectorization = tuning.slp_vectorization = True
    passes = llvm.create_pass_builder(machine, tuning)
    passes.getModulePassManager().run(module, passes)
    module.verify()
    return bytes(machine.emit_object(module))
