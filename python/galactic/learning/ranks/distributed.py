"""The processes that train one policy together: sums over ranks, and which ranks wait for which."""

from __future__ import annotations

import contextlib
import ctypes
import datetime
import hashlib
import math
import os
import pickle
import socket
from collections.abc import Iterator

import torch
import torch.distributed
from torch import Tensor
from torch.distributed.rendezvous import rendezvous

from galactic import interrupts
from galactic.errors import Error
from galactic.learning.refusals import CheckpointError, SettingsError


class RankLost(Exception):
    """Another rank has ended; it has printed why."""


def cuda_devices() -> int:
    """The number of CUDA devices that torch can use."""
    return torch.cuda.device_count() if torch.cuda.is_available() else 0


def device_of(
    name: str, local_rank: int, local_ranks: int, *, is_dealt: bool = False
) -> torch.device:
    """The device for the networks of a rank, one of `local_ranks` on this machine: a CUDA device of
    its own, or the processor. `name`: cpu, cuda, or auto, which takes CUDA devices if there is one
    for each rank. `is_dealt`: each rank sees exactly one device, which no other rank sees
    (devices_are_dealt()). Raises SettingsError if `name` is cuda and torch has too few devices."""
    devices = cuda_devices()
    if name != "cpu" and is_dealt:
        return torch.device("cuda", 0)
    if name == "cuda" and devices == 0:
        raise SettingsError("--device: found cuda, but this torch has no CUDA device; take cpu")
    if name == "cuda" and devices < local_ranks:
        raise SettingsError(
            f"--ranks: found {local_ranks}, each of which needs a CUDA device of its own, of which this "
            f"machine has {devices}; take --ranks {devices} or --device cpu"
        )
    if name == "cpu" or devices < local_ranks:
        return torch.device("cpu")
    return torch.device("cuda", local_rank)


def devices_are_dealt(store: torch.distributed.Store, rank: int, size: int) -> bool:
    """Whether each rank sees exactly one CUDA device, and each a different one, as with SLURM's
    --gpus-per-task and CUDA_VISIBLE_DEVICES. All ranks must call this together."""
    own = f"{socket.gethostname()} {_uuid_of_first()}" if cuda_devices() == 1 else ""
    store.set(f"device/{rank}", own)
    seen = [store.get(f"device/{other}").decode() for other in range(size)]
    return "" not in seen and len(set(seen)) == size


def _uuid_of_first() -> str:
    """The UUID of the first device that CUDA's driver shows to this process. Torch 1.13 does not
    provide it."""
    try:
        driver = ctypes.CDLL("libcuda.so.1")
    except OSError:  # for example, if torch's devices are not NVIDIA's
        return "unknown"
    device, uuid = ctypes.c_int(), ctypes.create_string_buffer(16)
    # The second version distinguishes the parts of a partitioned device.
    ask = getattr(driver, "cuDeviceGetUuid_v2", driver.cuDeviceGetUuid)
    failed = driver.cuInit(0) or driver.cuDeviceGet(ctypes.byref(device), 0) or ask(uuid, device)
    return "unknown" if failed else uuid.raw.hex()


def local_ranks() -> int:
    """The number of ranks of the run on this machine."""
    return int(os.environ.get("LOCAL_WORLD_SIZE", "1"))


def threads_of(wanted: int, local_ranks: int) -> int:
    """The number of threads of one rank: `wanted`, or if that is 0, its share of the processors
    that this process may use."""
    return wanted or max(1, len(os.sched_getaffinity(0)) // local_ranks)


def where_words(group: Group, drawn_by: str | None) -> str:
    """A line for the start of a run: where the networks of this rank run, and what draws its
    images."""
    if group.device.type == "cuda":
        place = f"{group.device} ({torch.cuda.get_device_name(group.device)})"
    else:
        unused = cuda_devices()
        place = "the processor"
        if unused:
            place += (
                f", though there are CUDA devices: {unused} of them for {local_ranks()} ranks here"
            )
    draws = "" if drawn_by is None else f"; images are drawn by {drawn_by}"
    return f"networks run on {place}{draws}" + (" (rank 0)" if group.size > 1 else "")


class Group:
    """All ranks of a run. With a single process, sums leave their tensors as they are.

    Started by torchrun (`python3 -m torch.distributed.run`), a process finds its rank in the
    environment, and join() connects it: gloo between processors, NCCL between GPUs.
    """

    def __init__(self, rank: int, size: int, device: torch.device):
        self.rank = rank
        self.size = size
        self.device = device
        self._store: torch.distributed.Store | None = None
        # The number of steps of together() that are over.
        self._steps = 0

    @classmethod
    def alone(cls, device: torch.device | None = None) -> Group:
        """The group of a single process."""
        return cls(0, 1, device or torch.device("cpu"))

    @classmethod
    def join(cls, device: str = "auto") -> Group:
        """Joins the group that the environment describes. `device`: as in device_of()."""
        size = int(os.environ.get("WORLD_SIZE", "1"))
        rank = int(os.environ.get("RANK", "0"))
        local_rank = int(os.environ.get("LOCAL_RANK", "0"))
        store, is_dealt = None, False
        if size > 1:
            with interrupts.ended_at_once():
                store = next(rendezvous("env://"))[0]
                asked = torch.distributed.PrefixStore("devices", store)
                is_dealt = devices_are_dealt(asked, rank, size)
        group = cls(rank, size, device_of(device, local_rank, local_ranks(), is_dealt=is_dealt))
        is_cuda = group.device.type == "cuda"
        if is_cuda:
            torch.cuda.set_device(group.device)
        if store is not None:
            with interrupts.ended_at_once():
                torch.distributed.init_process_group(
                    "nccl" if is_cuda else "gloo",
                    store=torch.distributed.PrefixStore("group", store),
                    rank=rank,
                    world_size=size,
                    timeout=datetime.timedelta(minutes=30),
                )
            group._store = torch.distributed.PrefixStore("galactic", store)
        return group

    def leave(self) -> None:
        if self.size > 1:
            torch.distributed.destroy_process_group()

    def sum(self, tensor: Tensor) -> Tensor:
        """Adds up `tensor` over all ranks, in place; all ranks get the same bits. Returns
        `tensor`."""
        if self.size > 1:
            with _others():
                torch.distributed.all_reduce(tensor)
        return tensor

    def copy_from_first(self, tensor: Tensor) -> None:
        """Copies the first rank's `tensor` to all ranks, in place."""
        if self.size > 1:
            with _others():
                torch.distributed.broadcast(tensor, 0)

    def wait_for_all(self) -> None:
        if self.size > 1:
            with _others():
                torch.distributed.barrier()

    @contextlib.contextmanager
    def together(self, *more: type[Exception]) -> Iterator[None]:
        """A context for a step of all ranks, in which each does its part, or nothing. No rank
        leaves it before all have reached its end. An error in one rank is raised on all; if there
        are several, the lowest rank's is. So there is one message and one exit code, and no rank
        waits for one that has ended.

        Sums and copy_from_first() are not allowed within: a rank that fails would not reach them.
        Only SettingsError, CheckpointError, Error and the types `more` are shared. Any other
        exception, such as from user code, ends its own rank, and the others raise RankLost.
        """
        shared: tuple[type[Exception], ...] = (SettingsError, CheckpointError, Error, *more)
        fault: Exception | None = None
        try:
            yield
        except shared as error:
            fault = error
        for one in self._faults(fault):
            if one is not None:
                raise one

    def _faults(self, own: Exception | None) -> list[Exception | None]:
        """The errors of all ranks in the step that they are ending, in the order of ranks."""
        if self._store is None:
            return [own]
        # Keys are numbered: a rank may end the next step before another has read the errors of this
        # one.
        step, self._steps = self._steps, self._steps + 1
        self._store.set(_fault(step, self.rank), pickle.dumps(own).hex())
        try:
            self.wait_for_all()
            return self._said_by_all(self._store, step)
        except RankLost as lost:
            # A rank that learns of an error ends at once, perhaps before the others have passed the
            # barrier.
            with contextlib.suppress(RankLost):
                return [*self._said_by_all(self._store, step), lost]
            return [own, lost]

    def _said_by_all(self, store: torch.distributed.Store, step: int) -> list[Exception | None]:
        """The error of each rank, in the order of ranks. Raises RankLost if a rank does not report
        within seconds."""
        keys = [_fault(step, rank) for rank in range(self.size)]
        with _others():
            store.wait(keys, datetime.timedelta(seconds=5))
            return [pickle.loads(bytes.fromhex(store.get(key).decode())) for key in keys]

    def may_tell(self, error: BaseException) -> bool:
        """Whether this rank should print `error`. An error that several ranks have is printed once;
        that another rank has ended is printed only if no rank has printed anything. True if the
        other ranks cannot be reached."""
        if self._store is None:
            return True
        key = "told/" + hashlib.sha256(str(error).encode()).hexdigest()
        try:
            is_first = int(self._store.add("told", 1)) == 1
            return is_first if isinstance(error, RankLost) else int(self._store.add(key, 1)) == 1
        except RuntimeError:
            return True

    def stragglers(self, sync_fraction: float, shortest: float) -> Stragglers:
        return Stragglers(self._store, self.rank, self.size, sync_fraction, shortest)


@contextlib.contextmanager
def _others() -> Iterator[None]:
    """A context for collective operations; turns their failure into RankLost."""
    try:
        yield
    except RuntimeError as error:
        raise RankLost(f"another rank has ended, so this one ends, too ({error})") from error


def _fault(step: int, rank: int) -> str:
    return f"fault/{step}/{rank}"


class Stragglers:
    """Ends the rollouts of slow ranks early, so that fast ones need not wait (DD-PPO, section 3).

    When `sync_fraction` of the ranks have finished their rollout, the others stop where they are
    and go on to the update with what they have, but not before the share `shortest` of their
    rollout is done. With a fraction of 1, or a single rank, no rollout is cut short.
    """

    def __init__(self, store: torch.distributed.Store | None, rank: int, size: int,
                 sync_fraction: float, shortest: float):  # fmt: skip
        self._store = store if sync_fraction < 1.0 else None
        self._rank = rank
        # The rounding error of a product such as 0.07 * 100 must not add a rank.
        self._enough = max(1, math.ceil(sync_fraction * size - 1e-9))
        self._shortest = shortest

    def should_stop(self, update: int, step: int, horizon: int) -> bool:
        """Whether to end the rollout of `update` after `step` of `horizon` steps."""
        # Reading the store is a network round trip, so do that only sixteen times per rollout.
        every = max(1, horizon // 16)
        if self._store is None or step % every or step < self._shortest * horizon:
            return False
        return self._store.add(_done(update), 0) >= self._enough

    def finished(self, update: int) -> None:
        """Tells the other ranks that this rank's rollout is complete."""
        if self._store is not None:
            self._store.add(_done(update), 1)

    def forget(self, update: int) -> None:
        """Deletes the store's counter of an update that all ranks have completed."""
        if self._store is not None and self._rank == 0:
            self._store.delete_key(_done(update))


def _done(update: int) -> str:
    return f"rollouts_done/{update}"
