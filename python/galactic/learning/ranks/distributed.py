"""The processes that train one policy together: sums over ranks, and who waits for whom."""

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
    """Another rank has ended: what it said is above."""


def cuda_devices() -> int:
    """How many torch has."""
    return torch.cuda.device_count() if torch.cuda.is_available() else 0


def device_of(
    name: str, local_rank: int, local_ranks: int, *, is_dealt: bool = False
) -> torch.device:
    """Where the networks of a rank run, one of so many on this machine: on a CUDA device of its own, or
    on the processor. `name`: cpu, cuda, or auto, which takes CUDA devices if there is one for each rank.
    `is_dealt`: each rank sees one device alone, which no other rank sees (devices_are_dealt()).
    SettingsError where cuda asks for more than torch has."""
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
    """Whether each of the ranks sees one CUDA device alone, and each another one, as SLURM's --gpus-per-task
    and CUDA_VISIBLE_DEVICES have it. All of them ask at the same time."""
    own = f"{socket.gethostname()} {_uuid_of_first()}" if cuda_devices() == 1 else ""
    store.set(f"device/{rank}", own)
    seen = [store.get(f"device/{other}").decode() for other in range(size)]
    return "" not in seen and len(set(seen)) == size


def _uuid_of_first() -> str:
    """Of the first device that CUDA's driver shows this process: torch 1.13 does not tell it."""
    try:
        driver = ctypes.CDLL("libcuda.so.1")
    except OSError:  # such as where torch's devices are others than NVIDIA's
        return "unknown"
    device, uuid = ctypes.c_int(), ctypes.create_string_buffer(16)
    # The second version tells parts of a device apart.
    ask = getattr(driver, "cuDeviceGetUuid_v2", driver.cuDeviceGetUuid)
    failed = driver.cuInit(0) or driver.cuDeviceGet(ctypes.byref(device), 0) or ask(uuid, device)
    return "unknown" if failed else uuid.raw.hex()


def local_ranks() -> int:
    """How many ranks of the run are on this machine."""
    return int(os.environ.get("LOCAL_WORLD_SIZE", "1"))


def threads_of(wanted: int, local_ranks: int) -> int:
    """Of one rank; 0: its share of the processors that this process may use."""
    return wanted or max(1, len(os.sched_getaffinity(0)) // local_ranks)


def where_words(group: Group, drawn_by: str | None) -> str:
    """Where networks run and what draws the images, for a line at the start of a run: in the rank that tells it."""
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
    """All ranks of a run; of one process alone, every sum is what it was.

    Started by torchrun (`python3 -m torch.distributed.run`), a process finds its rank in the
    environment, and join() connects it: gloo between processors, NCCL between GPUs.
    """

    def __init__(self, rank: int, size: int, device: torch.device):
        self.rank = rank
        self.size = size
        self.device = device
        self._store: torch.distributed.Store | None = None
        # How many steps of together() are over.
        self._steps = 0

    @classmethod
    def alone(cls, device: torch.device | None = None) -> Group:
        """The only process there is."""
        return cls(0, 1, device or torch.device("cpu"))

    @classmethod
    def join(cls, device: str = "auto") -> Group:
        """The group that the environment describes. `device`: as device_of() takes it."""
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
        """Adds up `tensor` over all ranks, in place; all get the same bits. Returns it."""
        if self.size > 1:
            with _others():
                torch.distributed.all_reduce(tensor)
        return tensor

    def copy_from_first(self, tensor: Tensor) -> None:
        """Gives every rank the first one's `tensor`, in place."""
        if self.size > 1:
            with _others():
                torch.distributed.broadcast(tensor, 0)

    def wait_for_all(self) -> None:
        if self.size > 1:
            with _others():
                torch.distributed.barrier()

    @contextlib.contextmanager
    def together(self, *more: type[Exception]) -> Iterator[None]:
        """Around a step of all ranks, of which each does its part, or nothing: none of them goes on before all have
        come to its end. What is refused in one of them is raised on all, of several the first rank's: it is then one
        sentence and one exit code, and nobody waits for a rank that has ended.

        No sum and no copy_from_first() may be within: a rank that is refused something would not come to it. What else
        is raised, also by code of the user's, is that rank's own, and the others meet RankLost. `more`: kinds of
        exceptions that are shared, too.
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
        """Those of all ranks in the step that they end, in their order."""
        if self._store is None:
            return [own]
        # A rank may be at the end of the next step before another one has read what was said at that of this one.
        step, self._steps = self._steps, self._steps + 1
        self._store.set(_fault(step, self.rank), pickle.dumps(own).hex())
        try:
            self.wait_for_all()
            return self._said_by_all(self._store, step)
        except RankLost as lost:
            # One that knows of an error ends at once, perhaps before the others have met it.
            with contextlib.suppress(RankLost):
                return [*self._said_by_all(self._store, step), lost]
            return [own, lost]

    def _said_by_all(self, store: torch.distributed.Store, step: int) -> list[Exception | None]:
        """The fault of each rank, in their order. RankLost where one has said nothing and says nothing."""
        keys = [_fault(step, rank) for rank in range(self.size)]
        with _others():
            store.wait(keys, datetime.timedelta(seconds=5))
            return [pickle.loads(bytes.fromhex(store.get(key).decode())) for key in keys]

    def may_tell(self, error: BaseException) -> bool:
        """Whether this rank tells its user of `error`: what all of them find out is told once, and that
        another rank has ended only where none has told why. True where the others cannot be asked.
        """
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
    """Around what all ranks do together."""
    try:
        yield
    except RuntimeError as error:
        raise RankLost(f"another rank has ended, so this one ends, too ({error})") from error


def _fault(step: int, rank: int) -> str:
    return f"fault/{step}/{rank}"


class Stragglers:
    """Ends the rollouts of slow ranks early, so that fast ones need not wait (DD-PPO, section 3).

    When `sync_fraction` of the ranks have finished their rollout, the others stop where they are and
    go on to the update with what they have, but not before `shortest` of their rollout. A fraction of
    1, or a rank alone, waits for all.
    """

    def __init__(self, store: torch.distributed.Store | None, rank: int, size: int,
                 sync_fraction: float, shortest: float):  # fmt: skip
        self._store = store if sync_fraction < 1.0 else None
        self._rank = rank
        # What is lost in a product such as 0.07 * 100 is no rank more.
        self._enough = max(1, math.ceil(sync_fraction * size - 1e-9))
        self._shortest = shortest

    def should_stop(self, update: int, step: int, horizon: int) -> bool:
        """Whether the rollout of `update` ends after `step` of `horizon` steps."""
        # A look at the store is a trip over the network: sixteen for each rollout are enough.
        every = max(1, horizon // 16)
        if self._store is None or step % every or step < self._shortest * horizon:
            return False
        return self._store.add(_done(update), 0) >= self._enough

    def finished(self, update: int) -> None:
        """Tells the others that this rank's rollout has its full length."""
        if self._store is not None:
            self._store.add(_done(update), 1)

    def forget(self, update: int) -> None:
        """Frees what the store knows of an update that all ranks have left behind."""
        if self._store is not None and self._rank == 0:
            self._store.delete_key(_done(update))


def _done(update: int) -> str:
    return f"rollouts_done/{update}"
