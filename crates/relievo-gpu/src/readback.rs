use std::sync::mpsc;
use std::time::Duration;

use crate::GpuError;

/// How long the answer may take once the device is done: another thread that polled may be busy with other answers.
const ANSWER: Duration = Duration::from_secs(60);

/// The bytes of a buffer with usage MAP_READ, once the device has done everything submitted so far. Blocks.
pub(crate) fn read_buffer(device: &wgpu::Device, buffer: &wgpu::Buffer) -> Result<Vec<u8>, GpuError> {
    let (sender, receiver) = mpsc::channel();
    // The receiver is gone only after an error that has been given already.
    buffer.map_async(wgpu::MapMode::Read, .., move |result| drop(sender.send(result)));
    device.poll(wgpu::PollType::wait_indefinitely()).map_err(|error| GpuError::Device(error.to_string()))?;
    match receiver.recv_timeout(ANSWER) {
        Ok(Ok(())) => {}
        Ok(Err(error)) => return Err(GpuError::Device(error.to_string())),
        Err(_) => return Err(GpuError::Device("the device gave no answer when its memory was read".to_owned())),
    }
    let bytes = buffer.get_mapped_range(..).map_err(|error| GpuError::Device(error.to_string()))?.to_vec();
    buffer.unmap();
    Ok(bytes)
}
