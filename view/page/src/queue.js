// One thing after the other, however fast somebody clicks: what is to be shown may have to be unpacked first.

export class Queue {
  constructor() { this.last = Promise.resolve(); }

  /// Does a task when those before it are done, also where one of them failed. The promise of the task's end.
  add(task) {
    const end = this.last.then(task);
    this.last = end.catch(() => {});
    return end;
  }

  /// When all tasks are done that were added so far.
  idle() { return this.last; }
}
